// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "base/text.h"
#include "data/byte_source.h"
#include "data/faults.h"
#include "data/text_cursor.h"
#include "data/text_rows.h"
#include "rows/lammps_frame.h"
#include "rows/readers.h"

namespace orrery::rows {

using namespace data;  // NOLINT(google-build-using-namespace)

namespace {

struct Style {
  std::string_view name;
  std::string_view columns;
};

constexpr Style kStyles[] = {
    {"atomic", "id type x y z"},
    {"charge", "id type q x y z"},
    {"dipole", "id type q x y z mux muy muz"},
    {"molecular", "id mol type x y z"},
    {"bond", "id mol type x y z"},
    {"angle", "id mol type x y z"},
    {"full", "id mol type q x y z"},
    {"sphere", "id type diameter density x y z"},
    {"bpm/sphere", "id mol type diameter density x y z"},
};

/// A line without its comment.
std::string_view content(std::string_view line) { return line.substr(0, line.find('#')); }

ColumnType type_of_style_column(std::string_view column) {
  constexpr std::string_view kIntegers[] = {"id", "mol", "type", "ix", "iy", "iz"};
  return std::find(std::begin(kIntegers), std::end(kIntegers), column) != std::end(kIntegers) ? ColumnType::kInt64
                                                                                              : ColumnType::kFloat64;
}

/// Reads the file up to the first atom.
class DataHeader {
 public:
  DataHeader(const ByteSource& bytes, TextLayout& layout) : cursor_(bytes), faults_(bytes.file()), layout_(layout) {}

  FrameInfo read() {
    std::string line;
    if (cursor_.next(line)) info_.title = line;  // LAMMPS ignores the first line
    while (cursor_.next_filled(line)) {
      const auto words = words_of(content(line));
      if (words.empty()) continue;
      if (words[0] == "Atoms") {
        read_atoms(line);
        return finished();
      }
      read_property(words);
    }
    if (!rows_) faults_.fail(0, "no line \"N atoms\"");
    if (*rows_ > 0) faults_.fail(0, "no section \"Atoms\"", "the file is truncated");
    set_columns("atomic");
    layout_.rows = 0;
    return finished();
  }

 private:
  using Parts = std::vector<std::string_view>;

  std::uint64_t line() const { return cursor_.line() - 1; }

  /// A number of the header; lines of sections look different.
  double number(std::string_view word) {
    double value = 0;
    if (!parse_number(word, value) || !std::isfinite(value))
      faults_.fail(line(), fmt::format("'{}' is not a number", word));
    return value;
  }

  void read_property(const Parts& words) {
    const std::string_view last = words.back();
    if (words.size() == 2 && last == "atoms") {
      std::int64_t count = 0;
      if (!parse_integer(words[0], count) || count < 0)
        faults_.fail(line(), fmt::format("'{}' is not a number of atoms", words[0]));
      rows_ = static_cast<std::uint64_t>(count);
    }
    constexpr std::array<std::string_view, 3> kLow = {"xlo", "ylo", "zlo"};
    constexpr std::array<std::string_view, 3> kHigh = {"xhi", "yhi", "zhi"};
    constexpr std::array<std::string_view, 3> kEdges = {"avec", "bvec", "cvec"};
    for (std::size_t i = 0; i < 3; ++i) {
      if (words.size() == 4 && words[2] == kLow[i] && last == kHigh[i]) {
        bounds_[i] = {number(words[0]), number(words[1])};
        if (bounds_[i]->first > bounds_[i]->second)
          faults_.fail(line(), "a lower bound of the box exceeds the upper bound");
      }
      if (words.size() == 4 && last == kEdges[i])
        edges_[i] = Vec3d{number(words[0]), number(words[1]), number(words[2])};
    }
    if (words.size() == 6 && words[3] == "xy" && last == "yz")
      for (std::size_t i = 0; i < 3; ++i) tilt_[i] = number(words[i]);
    if (words.size() == 5 && words[3] == "abc" && last == "origin")
      origin_ = Vec3d{number(words[0]), number(words[1]), number(words[2])};
    if (words.size() == 3 && words[0] == "Atom" && words[1] == "Type" && last == "Labels") has_labels_ = true;
  }

  void read_atoms(const std::string& title) {
    if (!rows_) faults_.fail(line(), "no line \"N atoms\" before the section \"Atoms\"");
    const auto hash = title.find('#');
    const Parts style =
        words_of(hash == std::string::npos ? std::string_view() : std::string_view(title).substr(hash + 1));
    std::string known;
    for (const Style& s : kStyles) known += (known.empty() ? "" : ", ") + std::string(s.name);
    if (style.empty())
      faults_.fail(line(), "the section \"Atoms\" does not name its style, which determines the meaning of its columns",
                   "write for example \"Atoms # full\"; styles: " + known);
    if (style.size() != 1 || !set_columns(style[0]))
      faults_.fail(line(), fmt::format("atom style \"{}\" is not supported", style[0]), "supported: " + known);
    TextCursor::Place place = cursor_.place();
    std::string row;
    while (cursor_.next(row) && words_of(row).empty()) place = cursor_.place();
    layout_.begin = place.offset;
    layout_.first_line = place.line;
    layout_.rows = *rows_;
    if (*rows_ == 0) return;
    layout_.comment = '#';
    const Parts words = words_of(content(row));
    if (words.size() == info_.columns.size() + 3)
      for (const char* const name : {"ix", "iy", "iz"}) info_.columns.push_back({name, ColumnType::kInt64});
    for (std::size_t c = 0; c < std::min(words.size(), info_.columns.size()); ++c) {
      std::int64_t ignored = 0;
      const bool is_label = has_labels_ && info_.columns[c].name == "type" && !parse_integer(words[c], ignored);
      if (is_label) info_.columns[c].type = ColumnType::kText;
    }
  }

  bool set_columns(std::string_view style) {
    for (const Style& s : kStyles)
      if (s.name == style) {
        for (const std::string_view name : words_of(s.columns))
          info_.columns.push_back({std::string(name), type_of_style_column(name)});
        return true;
      }
    return false;
  }

  FrameInfo finished() {
    info_.rows = *rows_;
    if (edges_[0] && edges_[1] && edges_[2]) {
      info_.box = Box{origin_, {*edges_[0], *edges_[1], *edges_[2]}};
    } else if (bounds_[0] && bounds_[1] && bounds_[2]) {
      const auto [x, y, z] = bounds_;
      info_.box =
          lammps_box({x->first, y->first, z->first}, {x->second, y->second, z->second}, tilt_[0], tilt_[1], tilt_[2]);
    }
    for (const ColumnInfo& column : info_.columns) {
      if (column.name == "diameter") info_.roles.radius = column.name;
      if (column.name == "ix") info_.roles.image = {"ix", "iy", "iz"};
    }
    info_.roles.radius_scale = info_.roles.radius.empty() ? 1 : 0.5;
    info_.roles.position = {"x", "y", "z"};
    info_.roles.id = "id";
    info_.roles.type = "type";
    return info_;
  }

  TextCursor cursor_;
  Faults faults_;
  TextLayout& layout_;
  FrameInfo info_;
  std::optional<std::uint64_t> rows_;
  std::array<std::optional<std::pair<double, double>>, 3> bounds_;
  std::array<double, 3> tilt_ = {0, 0, 0};
  std::array<std::optional<Vec3d>, 3> edges_;
  Vec3d origin_{0, 0, 0};
  bool has_labels_ = false;
};

class LammpsData final : public DataFile {
 public:
  explicit LammpsData(Bytes bytes) : bytes_(std::move(bytes)), info_(DataHeader(*bytes_, layout_).read()) {}

  Format format() const override { return Format::kLammpsData; }
  int frame_count() override { return 1; }
  FrameInfo describe(int) override { return info_; }
  std::uint64_t memory() const override { return bytes_->memory(); }

  Table read(int, const std::vector<std::string>& columns) override {
    TextLayout layout = layout_;
    for (const ColumnInfo& column : info_.columns)
      layout.columns.push_back({column.type, base::contains(columns, column.name)});
    Faults faults(bytes_->file());
    TextTable text = read_text_rows(*bytes_, layout, faults);
    require_end(TextCursor(*bytes_, {text.end, layout.first_line + text.rows}));
    Table table;
    table.rows = text.rows;
    for (std::size_t c = 0; c < info_.columns.size(); ++c)
      if (layout.columns[c].is_wanted) table.columns.push_back({info_.columns[c].name, std::move(text.values[c])});
    return table;
  }

 private:
  /// Checks that the atoms are followed by a section or by the end of the file.
  void require_end(TextCursor cursor) const {
    std::string line;
    while (cursor.next_filled(line)) {
      const auto words = words_of(content(line));
      double number = 0;
      if (words.empty()) continue;
      if (parse_number(words[0], number))
        Faults(bytes_->file())
            .fail(cursor.line() - 1, fmt::format("more rows than {} atoms", info_.rows),
                  fmt::format("correct the line \"{} atoms\", or remove the rows", info_.rows));
      return;
    }
  }

  Bytes bytes_;
  TextLayout layout_;  ///< without columns
  FrameInfo info_;
};

}  // namespace

bool is_lammps_data(const Signature& signature) {
  // The only line that each of these files has.
  std::string_view text = signature.head;
  for (std::size_t at = text.find('\n'); at != std::string_view::npos; at = text.find('\n')) {
    text.remove_prefix(at + 1);
    const auto words = words_of(content(text.substr(0, text.find('\n'))));
    if (words.size() == 2 && words[1] == "atoms" && words[0].find_first_not_of("0123456789") == std::string_view::npos)
      return true;
  }
  return false;
}

std::unique_ptr<DataFile> open_lammps_data(const Bytes& bytes, const OpenOptions&) {
  return std::make_unique<LammpsData>(bytes);
}

}  // namespace orrery::rows
