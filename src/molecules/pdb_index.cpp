// SPDX-License-Identifier: Apache-2.0
#include "molecules/pdb_index.h"

#include <algorithm>
#include <charconv>

#include "data/byte_source.h"
#include "data/faults.h"
#include "molecules/biomt.h"
#include "molecules/require_text.h"

namespace orrery::molecules {

using namespace data;  // NOLINT(google-build-using-namespace)

namespace {

constexpr std::size_t kMaxLine = 120;
constexpr std::size_t kMaxTitle = 1000;
/// Columns of a record, and of its name.
constexpr std::size_t kRecordWidth = 80, kRecordName = 6;

/// The text in a range of a record's columns, 1-based and inclusive, without surrounding spaces.
std::string columns(std::string_view line, std::size_t first, std::size_t last) {
  const std::string_view field = line.substr(std::min(first - 1, line.size()), last - first + 1);
  const std::size_t begin = field.find_first_not_of(' ');
  if (begin == std::string_view::npos) return {};
  return std::string(field.substr(begin, field.find_last_not_of(' ') + 1 - begin));
}

std::optional<double> number(const std::string& text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

class Indexer {
 public:
  Indexer(PdbIndex& index, Faults& faults) : index_(index), faults_(faults) {}

  void take(std::string_view line, std::uint64_t offset) {
    ++line_;
    // Other characters are common in the text of remarks and titles.
    const std::string_view record = line.substr(0, is_pdb_atom(line) ? kRecordWidth : kRecordName);
    if (std::any_of(record.begin(), record.end(), [](char c) { return static_cast<unsigned char>(c) > 0x7e; }))
      faults_.add_of_many(line_, "the record has characters that are not ASCII");
    if (is_pdb_atom(line)) {
      has_atoms_ = true;
      ++atoms_;
      has_end_ = false;
    } else if (line.starts_with("MODEL ")) {
      finish(offset, line_);
      is_declared_ = true;
      model_.number = number(columns(line, 7, 14));
    } else if (line.starts_with("END") && (line.starts_with("ENDMDL") || columns(line, 4, 6).empty())) {
      finish(offset, line_);
      has_end_ = !line.starts_with("ENDMDL");
    } else if (line.starts_with("HEADER")) {
      has_header_ = true;
    } else if (line.starts_with("MASTER")) {
      declared_atoms_ = number(columns(line, 51, 55));
    } else if (line.starts_with("CRYST1")) {
      model_.cell = line;
    } else if (line.starts_with("TITLE ") && index_.title.size() < kMaxTitle) {
      index_.title += (index_.title.empty() ? "" : " ") + columns(line, 11, 80);
    } else if (line.starts_with("REMARK 350")) {
      biomt_.take(line.substr(10), line_, faults_);
    }
  }

  void finish_file(std::uint64_t size) {
    faults_.raise_if_any();
    const bool has_all_atoms = declared_atoms_ && *declared_atoms_ == static_cast<double>(atoms_);
    if (has_header_ && !has_end_ && !has_all_atoms)
      faults_.fail(line_, "truncated: the file has HEADER, but not the record END",
                   "download the file again; if it is complete, add a line END");
    finish(size, line_);
    if (index_.models.empty()) index_.models.push_back({0, 0, 1, std::nullopt, {}});
    index_.assemblies = biomt_.finish(faults_);
  }

 private:
  /// Ends the current model, unless it is only what precedes the first one or follows the last.
  void finish(std::uint64_t end, std::uint64_t line) {
    if (!has_atoms_ && !is_declared_) return;
    model_.end = end;
    index_.models.push_back(model_);
    // The next model has the same cell unless it declares its own.
    model_ = {end, end, line, std::nullopt, model_.cell};
    has_atoms_ = is_declared_ = false;
  }

  PdbIndex& index_;
  Faults& faults_;
  BiomtReader biomt_;
  PdbModel model_;
  bool has_atoms_ = false;
  bool is_declared_ = false;  ///< by a MODEL record
  bool has_header_ = false;
  bool has_end_ = false;                  ///< after the last atom
  std::uint64_t atoms_ = 0;               ///< records
  std::optional<double> declared_atoms_;  ///< by the MASTER record
  std::uint64_t line_ = 0;
};

}  // namespace

void for_each_pdb_line(const ByteSource& bytes, std::uint64_t begin, std::uint64_t end,
                       const std::function<void(std::string_view line, std::uint64_t offset)>& take) {
  constexpr std::size_t kBlock = std::size_t{1} << 20;
  const auto cut = [](std::string_view line) {
    line = line.substr(0, kMaxLine);
    return line.ends_with('\r') ? line.substr(0, line.size() - 1) : line;
  };
  std::string rest;  // of a line that continues in the next block
  std::uint64_t line_begin = begin;
  for (std::uint64_t at = begin; at < end; at += kBlock) {
    const std::string block = bytes.text(at, static_cast<std::size_t>(std::min<std::uint64_t>(kBlock, end - at)));
    std::string_view left = block;
    for (std::size_t length; (length = left.find('\n')) != std::string_view::npos; left.remove_prefix(length + 1)) {
      if (rest.empty()) {
        take(cut(left.substr(0, length)), line_begin);
      } else {
        rest += left.substr(0, length).substr(0, kMaxLine);
        take(cut(rest), line_begin);
        rest.clear();
      }
      line_begin = at + block.size() - left.size() + length + 1;
    }
    if (rest.size() < kMaxLine) rest += left.substr(0, kMaxLine);
  }
  if (line_begin < end) take(cut(rest), line_begin);
}

PdbIndex index_pdb(const ByteSource& bytes) {
  Faults faults(bytes.file());
  require_text(bytes, faults);
  PdbIndex index;
  Indexer indexer(index, faults);
  for_each_pdb_line(bytes, 0, bytes.size(),
                    [&](std::string_view line, std::uint64_t offset) { indexer.take(line, offset); });
  indexer.finish_file(bytes.size());
  return index;
}

}  // namespace orrery::molecules
