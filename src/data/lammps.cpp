// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "base/text.h"
#include "data/bonds.h"
#include "data/frames.h"
#include "data/readers.h"

namespace orrery::data {

namespace {

using Axes = std::array<std::string, 3>;

const Axes kAxes = {"x", "y", "z"};
const Axes kUnwrapped = {"xu", "yu", "zu"};
const Axes kScaled = {"xs", "ys", "zs"};
const Axes kScaledUnwrapped = {"xsu", "ysu", "zsu"};

/// Converts a LAMMPS box, given by low and high coordinates and tilt factors.
Box lammps_box(const Vec3d& low, const Vec3d& high, double xy, double xz, double yz) {
  return {low, {Vec3d{high.x - low.x, 0, 0}, Vec3d{xy, high.y - low.y, 0}, Vec3d{xz, yz, high.z - low.z}}};
}

/// The number of rows that a word gives; none if it gives none.
std::optional<std::uint64_t> count_of(std::string_view word) {
  std::int64_t count = 0;
  if (!parse_integer(word, count) || count < 0) return std::nullopt;
  return static_cast<std::uint64_t>(count);
}

ColumnType type_of_column(std::string_view column) {
  if (column == "element" || column == "typelabel") return ColumnType::kText;
  const bool is_integer = base::contains({"id", "type", "mol", "ix", "iy", "iz", "proc", "procp1"}, column);
  return is_integer ? ColumnType::kInt64 : ColumnType::kFloat64;
}

/// Reads the items of a frame in a LAMMPS dump up to and including `ITEM: ATOMS`.
class FrameReader {
 public:
  FrameReader(TextCursor& cursor, Faults& faults) : cursor_(cursor), faults_(faults) {}

  /// Result     without the columns and roles of FrameInfo
  TextFrame read() {
    for (;;) {
      const std::string item = next_line();
      if (item.find_first_not_of(" \t") == std::string::npos) continue;
      if (!item.starts_with("ITEM:"))
        faults_.fail(item_line(), fmt::format("expected a line \"ITEM: ...\", found '{}'", item.substr(0, kMaxShown)),
                     "check the number of atoms of the previous frame, and the lines of its header");
      const std::string name = item.substr(std::min(item.find_first_not_of(" \t", 5), item.size()));
      if (name.starts_with("ATOMS")) {
        read_columns(name);
        return finished();
      }
      if (name.starts_with("TIMESTEP"))
        frame_.info.step = read_numbers(1, "a time step")[0];
      else if (name.starts_with("NUMBER OF ATOMS"))
        read_count();
      else if (name.starts_with("BOX BOUNDS"))
        read_box(name);
      else if (name.starts_with("UNITS") || name.starts_with("TIME"))
        next_line();
      else
        faults_.fail(item_line(), fmt::format("'ITEM: {}' is not an item of an atom dump", name.substr(0, kMaxShown)),
                     "supported: dumps of style atom and custom");
    }
  }

 private:
  static constexpr std::size_t kMaxShown = 60;

  std::uint64_t item_line() const { return cursor_.line() - 1; }

  std::string next_line() {
    std::string line;
    if (!cursor_.next(line))
      faults_.fail(cursor_.line(), "the file ends within the header of a frame",
                   "remove the incomplete frame at the end of the file");
    return line;
  }

  std::vector<double> read_numbers(std::size_t count, const std::string& what) {
    const std::string line = next_line();
    std::vector<double> numbers;
    for (const std::string_view word : words_of(line)) {
      double number = 0;
      if (!parse_number(word, number) || !std::isfinite(number)) break;
      numbers.push_back(number);
    }
    if (numbers.size() != count || words_of(line).size() != count)
      faults_.fail(item_line(), fmt::format("expected {}, found '{}'", what, line.substr(0, kMaxShown)));
    return numbers;
  }

  void read_count() {
    const std::string line = next_line();
    const auto words = words_of(line);
    if (words.size() == 1) rows_ = count_of(words[0]);
    if (words.size() != 1 || !rows_)
      faults_.fail(item_line(), fmt::format("expected a number of atoms, found '{}'", line.substr(0, kMaxShown)));
    frame_.count_line = item_line();
  }

  void read_box(const std::string& name) {
    const bool is_general = name.find(" abc") != std::string::npos;
    const bool is_tilted = name.find(" xy xz yz") != std::string::npos;
    const std::size_t count = is_general ? 4 : is_tilted ? 3 : 2;
    std::array<std::vector<double>, 3> v;
    for (auto& row : v) row = read_numbers(count, std::to_string(count) + " numbers of the box");
    Box& box = frame_.info.box.emplace();
    if (is_general) {
      box.origin = {v[0][3], v[1][3], v[2][3]};
      for (std::size_t i = 0; i < 3; ++i) box.edges[i] = {v[i][0], v[i][1], v[i][2]};
    } else {
      const double xy = is_tilted ? v[0][2] : 0;
      const double xz = is_tilted ? v[1][2] : 0;
      const double yz = is_tilted ? v[2][2] : 0;
      // The file has the bounds of the tilted box.
      const Vec3d low{v[0][0] - std::min({0.0, xy, xz, xy + xz}), v[1][0] - std::min(0.0, yz), v[2][0]};
      const Vec3d high{v[0][1] - std::max({0.0, xy, xz, xy + xz}), v[1][1] - std::max(0.0, yz), v[2][1]};
      if (!(low.x <= high.x && low.y <= high.y && low.z <= high.z))
        faults_.fail(item_line(), "a lower bound of the box exceeds the upper bound");
      box = lammps_box(low, high, xy, xz, yz);
    }
    // Old files have no boundary flags.
    std::vector<std::string_view> flags;
    for (const std::string_view word : words_of(name))
      if (word.size() == 2 && word.find_first_not_of("pfsm") == std::string_view::npos) flags.push_back(word);
    if (flags.size() == 3)
      for (std::size_t i = 0; i < 3; ++i) box.periodic[i] = flags[i][0] == 'p';
  }

  void read_columns(const std::string& name) {
    const auto words = words_of(name);
    if (words.size() > kMaxColumns)
      faults_.fail(item_line(), fmt::format("there are more than {} columns", kMaxColumns));
    UniqueNames names;
    for (std::size_t i = 1; i < words.size(); ++i) {
      const std::string column = names.add(std::string(words[i]));
      frame_.layout.columns.push_back({column, type_of_column(column)});
    }
  }

  TextFrame finished() {
    const char* const missing = !frame_.info.step ? "TIMESTEP" : !rows_ ? "NUMBER OF ATOMS" : nullptr;
    if (missing != nullptr)
      faults_.fail(item_line(), fmt::format("the frame has no item \"{}\" before its atoms", missing));
    frame_.info.rows = frame_.layout.rows = *rows_;
    frame_.layout.begin = cursor_.offset();
    frame_.layout.first_line = cursor_.line();
    return frame_;
  }

  TextCursor& cursor_;
  Faults& faults_;
  TextFrame frame_;
  std::optional<std::uint64_t> rows_;
};

bool contain(const std::vector<ColumnInfo>& columns, const Axes& axes) {
  return std::all_of(axes.begin(), axes.end(), [&](const std::string& axis) { return has_column(columns, axis); });
}

/// The columns from which positions are computed; null if the file has positions, or nothing to compute them from.
const Axes* scaled_axes(const std::vector<ColumnInfo>& columns) {
  if (contain(columns, kAxes) || contain(columns, kUnwrapped)) return nullptr;
  return contain(columns, kScaled) ? &kScaled : contain(columns, kScaledUnwrapped) ? &kScaledUnwrapped : nullptr;
}

/// Completes the description of a frame by the columns of its rows.
void describe_columns(const std::vector<ColumnInfo>& columns, FrameInfo& info) {
  const Axes* const scaled = scaled_axes(columns);
  info.columns = columns;
  if (scaled != nullptr)
    for (const std::string& axis : kAxes)
      if (!has_column(columns, axis)) info.columns.push_back({axis, ColumnType::kFloat64});
  const auto if_there = [&](const char* name) { return has_column(columns, name) ? name : std::string(); };
  Roles& roles = info.roles;
  roles.position = scaled != nullptr || contain(columns, kAxes) ? kAxes : kUnwrapped;
  roles.radius = if_there("radius");
  if (roles.radius.empty() && has_column(columns, "diameter")) {
    roles.radius = "diameter";
    roles.radius_scale = 0.5;
  }
  info.names_as_types = roles.element = if_there("element");
  roles.type = has_column(columns, "type") ? "type" : if_there("typelabel");
  roles.id = if_there("id");
  // Periodic image flags apply to wrapped coordinates only.
  const bool is_wrapped = contain(columns, kAxes) || scaled == &kScaled;
  if (is_wrapped && contain(columns, Axes{"ix", "iy", "iz"})) roles.image = {"ix", "iy", "iz"};
}

/// Whether the types of atoms are labels, as with `dump_modify types labels`: the first one is not a number.
///
/// `rows`     at the first row
bool has_labels(const TextFrame& frame, TextCursor rows) {
  const ColumnInfo* const type = find_named(frame.layout.columns, "type");
  std::string row;
  if (type == nullptr || frame.info.rows == 0 || !rows.next(row)) return false;
  const auto words = words_of(row);
  const auto column = static_cast<std::size_t>(type - frame.layout.columns.data());
  std::int64_t ignored = 0;
  return column < words.size() && !parse_integer(words[column], ignored);
}

class LammpsDump final : public TextFrames {
 public:
  LammpsDump(const Bytes& bytes, const OpenOptions& options) : TextFrames(bytes, options) {}

  Table read(int number, const std::vector<std::string>& columns) override {
    TextFrame frame = this->frame(number);
    const Axes* const scaled = scaled_axes(frame.layout.columns);
    frame.layout.wanted = scaled != nullptr ? with_sources(columns, kAxes, *scaled) : columns;
    Table table = read_rows(frame);
    if (frame.layout.wanted == columns) return table;
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (base::contains(columns, kAxes[axis]))
        table.columns.push_back({kAxes[axis], unscaled(table, *scaled, *frame.info.box, axis)});
    return in_order(std::move(table), columns);
  }

 private:
  TextFrame header(TextCursor cursor) override {
    Faults faults(bytes().file());
    TextFrame frame = FrameReader(cursor, faults).read();
    std::vector<ColumnInfo>& columns = frame.layout.columns;
    if (has_labels(frame, cursor))
      for (ColumnInfo& column : columns)
        if (column.name == "type") column.type = ColumnType::kText;
    const std::uint64_t line = cursor.line() - 1;
    const bool is_scaled = scaled_axes(columns) != nullptr;
    if (!is_scaled && !contain(columns, kAxes) && !contain(columns, kUnwrapped))
      faults.fail(line, "no columns with positions", "write x y z, xu yu zu, xs ys zs or xsu ysu zsu");
    if (is_scaled && !frame.info.box)
      faults.fail(line, "positions are scaled, but the frame has no item \"BOX BOUNDS\"");
    describe_columns(columns, frame.info);
    return frame;
  }

  std::uint64_t skip_header(TextCursor& cursor) const override {
    Faults faults(bytes().file());
    return FrameReader(cursor, faults).read().info.rows;
  }

  bool begins_frame(std::string_view line) const override { return line.starts_with("ITEM:"); }
};

/// Binary dumps since 2020 begin with a negative length and the style; older ones have no signature.
bool is_binary(std::string_view head) {
  return head.substr(0, 32).find("DUMPATOM") == 8 || head.substr(0, 32).find("DUMPCUSTOM") == 8;
}

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

/// Skips the blank lines after the title of a section, and reads its first row.
///
/// Result     the place of the row
TextCursor::Place first_row(TextCursor& cursor, std::string& row) {
  TextCursor::Place place = cursor.place();
  while (cursor.next(row) && words_of(row).empty()) place = cursor.place();
  return place;
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
    if (words.size() == 2 && (last == "atoms" || last == "bonds")) {
      const std::optional<std::uint64_t> count = count_of(words[0]);
      if (!count) faults_.fail(line(), fmt::format("'{}' is not a number of {}", words[0], last));
      (last == "atoms" ? rows_.emplace() : info_.bonds) = *count;
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
    const std::size_t hash = title.find('#');
    const Parts style = hash == std::string::npos ? Parts() : words_of(std::string_view(title).substr(hash + 1));
    std::string known;
    for (const Style& s : kStyles) known += (known.empty() ? "" : ", ") + std::string(s.name);
    if (style.empty())
      faults_.fail(line(), "the section \"Atoms\" does not name its style, which determines the meaning of its columns",
                   "write for example \"Atoms # full\"; styles: " + known);
    if (style.size() != 1 || !set_columns(style[0]))
      faults_.fail(line(), fmt::format("atom style \"{}\" is not supported", style[0]), "supported: " + known);
    std::string row;
    const TextCursor::Place place = first_row(cursor_, row);
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
      if (s.name == style)
        for (const std::string_view name : words_of(s.columns))
          info_.columns.push_back({std::string(name), type_of_column(name)});
    return !info_.columns.empty();
  }

  FrameInfo finished() {
    info_.rows = *rows_;
    info_.has_bonds = info_.bonds > 0;
    const auto [x, y, z] = bounds_;
    if (edges_[0] && edges_[1] && edges_[2])
      info_.box = Box{origin_, {*edges_[0], *edges_[1], *edges_[2]}};
    else if (x && y && z)
      info_.box =
          lammps_box({x->first, y->first, z->first}, {x->second, y->second, z->second}, tilt_[0], tilt_[1], tilt_[2]);
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

class LammpsData final : public SingleFrame {
 public:
  explicit LammpsData(const Bytes& bytes) : SingleFrame(bytes) {
    info_ = DataHeader(*bytes_, layout_).read();
    layout_.columns = info_.columns;
    Faults faults(bytes_->file());
    require_room(*bytes_, layout_, 0, faults);
  }

  Table read(int, const std::vector<std::string>& columns) override {
    TextTable atoms = read_atoms(columns);
    require_end(end_of(atoms, layout_), info_.rows, "atoms");
    return std::move(atoms.table);
  }

  std::vector<Bond> bonds(int, std::vector<std::string>&) override {
    if (info_.bonds == 0) return {};
    const TextTable atoms = read_atoms({"id"});
    const Table ends = read_bonds(end_of(atoms, layout_));
    Faults faults(bytes_->file());
    BondsById out(integers(atoms.table, 0), faults);
    for (std::size_t i = 0; i < ends.rows; ++i) out.add(integers(ends, 0)[i], integers(ends, 1)[i], bonds_line_ + i);
    return out.take();
  }

 private:
  TextTable read_atoms(const std::vector<std::string>& columns) const {
    TextLayout layout = layout_;
    layout.wanted = columns;
    Faults faults(bytes_->file());
    return read_text_rows(*bytes_, layout, faults);
  }

  static const std::vector<std::int64_t>& integers(const Table& table, std::size_t column) {
    return std::get<std::vector<std::int64_t>>(table.columns[column].values);
  }

  TextCursor end_of(const TextTable& rows, const TextLayout& layout) const {
    return TextCursor(*bytes_, {rows.end, layout.first_line + rows.table.rows});
  }

  /// Reads the rows of the section "Bonds": a number, a type, and two ids of atoms.
  ///
  /// `cursor`   after the atoms, which LAMMPS requires to come first
  Table read_bonds(TextCursor cursor) {
    Faults faults(bytes_->file());
    std::string line;
    do {
      if (!cursor.next_filled(line))
        faults.fail(0, fmt::format("no section \"Bonds\", but a line \"{} bonds\"", info_.bonds),
                    "the file is truncated");
    } while (words_of(content(line)) != std::vector<std::string_view>{"Bonds"});
    const TextCursor::Place place = first_row(cursor, line);
    bonds_line_ = place.line;
    TextLayout layout;
    layout.begin = place.offset;
    layout.first_line = place.line;
    layout.rows = info_.bonds;
    layout.comment = '#';
    for (const char* const name : {"number", "type", "a", "b"}) layout.columns.push_back({name, ColumnType::kInt64});
    layout.wanted = {"a", "b"};
    TextTable out = read_text_rows(*bytes_, layout, faults);
    require_end(end_of(out, layout), info_.bonds, "bonds");
    return std::move(out.table);
  }

  /// Checks that the rows of a section are followed by another section or by the end of the file.
  void require_end(TextCursor cursor, std::uint64_t count, const char* what) const {
    std::string line;
    while (cursor.next_filled(line)) {
      const auto words = words_of(content(line));
      double number = 0;
      if (words.empty()) continue;
      if (parse_number(words[0], number))
        Faults(bytes_->file())
            .fail(cursor.line() - 1, fmt::format("more rows than {} {}", count, what),
                  fmt::format("correct the line \"{} {}\", or remove the rows", count, what));
      return;
    }
  }

  TextLayout layout_;             ///< without columns
  std::uint64_t bonds_line_ = 0;  ///< of the first bond
};

bool is_lammps_dump(const Signature& signature) {
  return signature.head.starts_with("ITEM:") || is_binary(signature.head);
}

std::unique_ptr<DataFile> open_lammps_dump(const Bytes& bytes, const OpenOptions& options) {
  constexpr std::size_t kSignatureBytes = 32;
  if (is_binary(bytes->text(0, kSignatureBytes)))
    Faults(bytes->file())
        .fail(0, "binary LAMMPS dumps are not supported",
              "convert it with the tool binary2txt of LAMMPS, or write a text dump, which may be compressed: *.gz, "
              "*.zst");
  return std::make_unique<LammpsDump>(bytes, options);
}

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

}  // namespace

const FormatReader kLammpsDump = {"LAMMPS dump", is_lammps_dump, open_lammps_dump};
const FormatReader kLammpsData = {"LAMMPS data", is_lammps_data, open_as<LammpsData>};

}  // namespace orrery::data
