// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include <fmt/core.h>

#include "base/text.h"
#include "data/frames.h"
#include "data/npy_array.h"
#include "data/readers.h"

namespace orrery::data {

namespace {

/// Checks that the items of an array are rows of named columns.
void check_shape(const NpyHeader& header, Faults& faults) {
  const bool is_table = header.is_structured
                            ? header.shape.size() == 1
                            : header.shape.size() == 2 && (header.shape[1] == 3 || header.shape[1] == 4);
  if (is_table) return;
  faults.fail(0,
              fmt::format("the array has the shape {}{}", shape_text(header),
                          header.is_structured ? "; a structured array must have one dimension"
                                               : "; a plain array must be (N, 3), or (N, 4) with the radius last"),
              header.is_structured
                  ? "flatten it, e.g. with `reshape(-1)`"
                  : "transpose it, or save a structured array or an NPZ file, whose columns have names");
}

class NpyFile final : public SingleFrame {
 public:
  explicit NpyFile(const Bytes& bytes) : SingleFrame(bytes) {
    Faults faults(bytes->file());
    NpyHeader header;
    if (const std::string fault = parse_npy_header(bytes->text(0, kLongestNpyHeader), header); !fault.empty())
      faults.fail(0, fault);
    check_shape(header, faults);
    if (const std::uint64_t declared = npy_data_bytes(header); declared != bytes->size() - header.begin)
      faults.fail(0, fmt::format("the header declares an array with shape {} with items of {} bytes, but {} bytes "
                                 "follow; the file is truncated, or the header is wrong",
                                 shape_text(header), header.item_size, bytes->size() - header.begin));
    columns_ = npy_columns(header, "xyz", info_.columns);
    if (!header.is_structured) {
      constexpr const char* kNames[] = {"x", "y", "z", "radius"};
      for (std::size_t i = 0; i < columns_.size(); ++i) columns_[i].name = info_.columns[i].name = kNames[i];
    }
    check_unique(faults);
    info_.rows = header.rows();
    info_.roles = required_roles(info_.columns, faults);
    info_.names_as_types = info_.roles.element;
  }

  Table read(int, const std::vector<std::string>& names) override {
    Faults faults(bytes_->file());
    std::vector<NpyColumn> columns;
    for (const std::string& name : names) columns.push_back(*find_named(columns_, name));
    Table table;
    table.rows = static_cast<std::size_t>(info_.rows);
    table.columns = read_npy_columns(*bytes_, info_.rows, columns, faults);
    faults.raise_if_any();
    return table;
  }

 private:
  void check_unique(Faults& faults) const {
    for (std::size_t i = 0; i < columns_.size(); ++i)
      for (std::size_t k = 0; k < i; ++k)
        if (columns_[i].name == columns_[k].name) faults.fail(0, "duplicate column " + quoted_word(columns_[i].name));
  }

  std::vector<NpyColumn> columns_;
};

using namespace std::string_view_literals;

/// Maximum number of members of an archive.
constexpr std::size_t kMaxMembers = 10000;

struct Member {
  std::string name;  ///< without ".npy"
  NpyHeader header;
  std::string fault;  ///< why it cannot be a column; empty: it can
  std::vector<NpyColumn> columns;
};

/// Reads the header of the archive's current member.
Member described(ZipReader& zip) {
  constexpr std::uint64_t kShortestHead = 12;
  Member member;
  member.name = zip.name().substr(0, zip.name().rfind(".npy"));
  std::string head = zip.read_text(kShortestHead);
  if (!has_npy_signature(head)) {
    member.fault = "not an array in NumPy's format";
    return member;
  }
  const std::uint64_t end = std::min<std::uint64_t>(npy_header_end(head), kLongestNpyHeader);
  head += zip.read_text(static_cast<std::size_t>(end - std::min<std::uint64_t>(end, head.size())));
  member.fault = parse_npy_header(head, member.header);
  const NpyHeader& header = member.header;
  const bool is_table =
      header.shape.size() == 1 || (header.shape.size() == 2 && !header.is_structured && header.shape[1] <= kMaxColumns);
  if (member.fault.empty() && !is_table)
    member.fault = fmt::format("the shape {} is not that of one or more columns", shape_text(header));
  return member;
}

/// Returns whether a member contains positions, and therefore defines the number of rows.
bool has_positions(const Member& member) {
  const NpyHeader& header = member.header;
  if (!member.fault.empty()) return false;
  std::vector<ColumnInfo> columns;
  if (header.is_structured || header.shape.size() == 1 || header.shape[1] == 3)
    for (const NpyColumn& column : npy_columns(header, member.name, columns))
      if (column.name == "x" || column.name == "X" || column.name == "x0") return true;
  return false;
}

class NpzFile final : public SingleFrame {
 public:
  NpzFile(const Bytes& bytes, const OpenOptions& options) : SingleFrame(bytes), limit_(options.decompressed_limit) {
    Faults faults(bytes->file());
    for (ZipReader zip(*bytes); zip.next();) {
      members_.push_back(described(zip));
      if (members_.size() > kMaxMembers)
        faults.fail(0, fmt::format("the archive has more than {} members", kMaxMembers));
    }
    const auto positions = std::find_if(members_.begin(), members_.end(), has_positions);
    if (positions == members_.end())
      faults.fail(0, "there is no array of positions; the arrays are: " + listed_members(),
                  "save an array `pos` with shape (N, 3), or arrays `x`, `y` and `z` with shape (N,)");
    info_.rows = positions->header.rows();
    for (Member& member : members_) add_columns(member);
    info_.roles = required_roles(info_.columns, faults);
    info_.names_as_types = info_.roles.element;
  }

  /// One array is decompressed at a time.
  std::uint64_t memory() const override {
    std::uint64_t largest = 0;
    for (const Member& member : members_)
      if (!member.columns.empty()) largest = std::max(largest, npy_data_bytes(member.header));
    return SingleFrame::memory() + largest;
  }

  Table read(int, const std::vector<std::string>& names) override {
    Faults faults(bytes_->file());
    Table table;
    table.rows = static_cast<std::size_t>(info_.rows);
    table.columns.resize(names.size());
    std::uint64_t limit = limit_;
    ZipReader zip(*bytes_);
    for (const Member& member : members_) {
      zip.next();
      std::vector<NpyColumn> columns;
      std::vector<std::size_t> targets;
      for (std::size_t i = 0; i < names.size(); ++i)
        for (const NpyColumn& column : member.columns)
          if (column.name == names[i]) {
            columns.push_back(column);
            targets.push_back(i);
          }
      if (columns.empty()) continue;
      const auto array = ByteSource::of_memory(bytes_->file(), array_bytes(zip, member, limit, faults));
      std::vector<Column> read = read_npy_columns(*array, info_.rows, columns, faults);
      for (std::size_t i = 0; i < targets.size(); ++i) table.columns[targets[i]] = std::move(read[i]);
    }
    faults.raise_if_any();
    return table;
  }

 private:
  /// Makes columns from an array if it has as many rows as there are positions. Other arrays, such as times, boxes and
  /// images, are not columns.
  void add_columns(Member& member) {
    if (!member.fault.empty() || member.header.rows() != info_.rows) return;
    const std::vector<ColumnInfo> before = info_.columns;
    member.columns = npy_columns(member.header, member.name, info_.columns);
    Faults faults(bytes_->file());
    for (const NpyColumn& column : member.columns)
      if (has_column(before, column.name)) faults.fail(0, "duplicate column " + quoted_word(column.name));
    if (info_.columns.size() > kMaxColumns) faults.fail(0, fmt::format("there are more than {} columns", kMaxColumns));
  }

  std::string listed_members() const {
    std::vector<ColumnInfo> names;
    for (const Member& member : members_)
      names.push_back({member.name +
                       (member.fault.empty() ? " " + shape_text(member.header) : fmt::format(" ({})", member.fault))});
    return listed(names);
  }

  /// Decompresses an array, at most `limit` bytes, and subtracts its size from the limit.
  static ByteBlocks array_bytes(ZipReader& zip, const Member& member, std::uint64_t& limit, Faults& faults) {
    const std::uint64_t data = npy_data_bytes(member.header), begin = member.header.begin;
    if (data > limit || begin > limit - data)
      faults.fail(0, fmt::format("array {} with shape {} exceeds the limit of {} of decompressed data",
                                 quoted_word(member.name), shape_text(member.header), base::bytes_text(limit)));
    limit -= data + begin;
    ByteBlocks bytes = zip.read(data + begin + 1);
    if (bytes.size() != data + begin)
      faults.fail(0, fmt::format("array {} with shape {} needs {} bytes of data, but {} follow its header",
                                 quoted_word(member.name), shape_text(member.header), data,
                                 bytes.size() > data + begin
                                     ? "more"
                                     : std::to_string(bytes.size() -
                                                      std::min(begin, static_cast<std::uint64_t>(bytes.size())))));
    return bytes;
  }

  std::uint64_t limit_;
  std::vector<Member> members_;  ///< all members of the archive, in its order
};

bool is_npy(const Signature& signature) { return has_npy_signature(signature.head); }

bool is_npz(const Signature& signature) {
  // Local file header of a ZIP archive: the length of the name at byte 26, the name at byte 30.
  constexpr std::size_t kNameLength = 26, kName = 30;
  const std::string& head = signature.head;
  if (signature.extension == ".npz") return head.starts_with("PK"sv);
  return head.starts_with("PK\3\4"sv) && head.size() > kName &&
         head.substr(kName, load<std::uint16_t>(head.data() + kNameLength, false)).ends_with(".npy");
}

}  // namespace

const FormatReader kNpy = {"NPY", is_npy, open_as<NpyFile>};
const FormatReader kNpz = {"NPZ", is_npz, open_as<NpzFile>};

}  // namespace orrery::data
