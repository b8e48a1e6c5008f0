// SPDX-License-Identifier: Apache-2.0
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/text.h"
#include "data/byte_source.h"
#include "data/elements.h"
#include "data/faults.h"
#include "data/text_cursor.h"
#include "data/text_frames.h"
#include "data/text_rows.h"
#include "rows/lammps_frame.h"
#include "rows/readers.h"

namespace orrery::rows {

using namespace data;  // NOLINT(google-build-using-namespace)

namespace {

using Axes = std::array<std::string, 3>;

const Axes kAxes = {"x", "y", "z"};
const Axes kUnwrapped = {"xu", "yu", "zu"};
const Axes kScaled = {"xs", "ys", "zs"};
const Axes kScaledUnwrapped = {"xsu", "ysu", "zsu"};

bool contain(const std::vector<std::string>& names, const Axes& axes) {
  return std::all_of(axes.begin(), axes.end(), [&](const std::string& axis) { return base::contains(names, axis); });
}

/// The type of a column of numbers, unless the types of atoms are labels.
ColumnType type_of_dump_column(std::string_view column, bool has_labels) {
  constexpr std::string_view kIntegers[] = {"id", "type", "mol", "ix", "iy", "iz", "proc", "procp1"};
  if (column == "element" || column == "typelabel" || (has_labels && column == "type")) return ColumnType::kText;
  return std::find(std::begin(kIntegers), std::end(kIntegers), column) != std::end(kIntegers) ? ColumnType::kInt64
                                                                                              : ColumnType::kFloat64;
}

/// The scaled columns from which positions are computed; null if the file has positions.
const Axes* scaled_position(const LammpsFrame& frame) {
  if (contain(frame.columns, kAxes) || contain(frame.columns, kUnwrapped)) return nullptr;
  if (contain(frame.columns, kScaled)) return &kScaled;
  return contain(frame.columns, kScaledUnwrapped) ? &kScaledUnwrapped : nullptr;
}

FrameInfo described(const LammpsFrame& frame) {
  FrameInfo info;
  info.rows = frame.rows;
  info.box = frame.box;
  info.step = frame.step;
  for (const std::string& column : frame.columns)
    info.columns.push_back({column, type_of_dump_column(column, frame.has_labels)});
  if (scaled_position(frame) != nullptr)
    for (const std::string& axis : kAxes)
      if (!base::contains(frame.columns, axis)) info.columns.push_back({axis, ColumnType::kFloat64});
  const auto if_there = [&](const char* name) { return base::contains(frame.columns, name) ? name : std::string(); };
  Roles& roles = info.roles;
  roles.position = scaled_position(frame) != nullptr || contain(frame.columns, kAxes) ? kAxes : kUnwrapped;
  roles.radius = if_there("radius");
  if (roles.radius.empty() && base::contains(frame.columns, "diameter")) {
    roles.radius = "diameter";
    roles.radius_scale = 0.5;
  }
  roles.element = if_there("element");
  roles.type = base::contains(frame.columns, "type") ? "type" : if_there("typelabel");
  roles.id = if_there("id");
  // Periodic image flags apply to wrapped coordinates only.
  const bool is_wrapped = contain(frame.columns, kAxes) || scaled_position(frame) == &kScaled;
  if (is_wrapped && contain(frame.columns, Axes{"ix", "iy", "iz"})) roles.image = {"ix", "iy", "iz"};
  return info;
}

/// One coordinate of positions that the file stores in units of the box.
std::vector<double> unscaled(const Box& box, std::size_t axis, const std::array<const double*, 3>& scaled,
                             std::size_t rows) {
  const auto part = [axis](const Vec3d& v) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; };
  const double origin = part(box.origin);
  const double a = part(box.edges[0]);
  const double b = part(box.edges[1]);
  const double c = part(box.edges[2]);
  std::vector<double> out(rows);
  constexpr std::size_t kGrain = std::size_t{1} << 16;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, rows, kGrain), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i)
      out[i] = origin + scaled[0][i] * a + scaled[1][i] * b + scaled[2][i] * c;
  });
  return out;
}

/// The requested columns, out of those that were read.
Table taken(const std::vector<std::string>& columns, const LammpsFrame& frame, TextTable text) {
  Table table;
  table.rows = text.rows;
  const auto values = [&](const std::string& name) -> Values& {
    const auto at = std::find(frame.columns.begin(), frame.columns.end(), name);
    return text.values[static_cast<std::size_t>(at - frame.columns.begin())];
  };
  // Computed columns first: the others are moved.
  if (const Axes* const names = scaled_position(frame); names != nullptr)
    for (std::size_t axis = 0; axis < kAxes.size(); ++axis) {
      if (!base::contains(columns, kAxes[axis])) continue;
      std::array<const double*, 3> scaled{};
      for (std::size_t i = 0; i < scaled.size(); ++i)
        scaled[i] = std::get<std::vector<double>>(values((*names)[i])).data();
      table.columns.push_back({kAxes[axis], unscaled(*frame.box, axis, scaled, table.rows)});
    }
  for (const std::string& name : columns)
    if (table.find(name) == nullptr) table.columns.push_back({name, std::move(values(name))});
  return table;
}

class LammpsDump final : public TextFrames {
 public:
  explicit LammpsDump(const Bytes& bytes) : TextFrames(bytes) {}

  Format format() const override { return Format::kLammpsDump; }

  FrameInfo describe(int frame) override {
    FrameInfo info = described(header(frame).first);
    if (!info.roles.element.empty()) settle_element(names(), info.roles);
    return info;
  }

  Table read(int number, const std::vector<std::string>& columns) override {
    const auto [frame, cursor] = header(number);
    const Axes* const scaled = scaled_position(frame);
    const auto is_computed = [&](const std::string& name) {
      return scaled != nullptr && std::count(kAxes.begin(), kAxes.end(), name) > 0;
    };
    const bool needs_scaled = std::any_of(columns.begin(), columns.end(), is_computed);
    TextLayout layout;
    layout.begin = cursor.offset();
    layout.rows = frame.rows;
    layout.first_line = cursor.line();
    for (const std::string& name : frame.columns) {
      const bool is_scaled = needs_scaled && std::count(scaled->begin(), scaled->end(), name) > 0;
      const bool is_wanted = !is_computed(name) && base::contains(columns, name);
      layout.columns.push_back({type_of_dump_column(name, frame.has_labels), is_wanted || is_scaled});
    }
    Faults faults(bytes().file());
    TextTable text = read_text_rows(bytes(), layout, faults);
    require_end(TextCursor(bytes(), {text.end, layout.first_line + text.rows}), frame.rows_line);
    return taken(columns, frame, std::move(text));
  }

 private:
  std::uint64_t skip_header(TextCursor& cursor) const override {
    Faults faults(bytes().file());
    return read_lammps_frame(cursor, faults).rows;
  }

  bool begins_frame(std::string_view line) const override { return line.starts_with("ITEM:"); }

  std::optional<Names> names_of(int number) override {
    const auto [frame, cursor] = header(number);
    const auto element = std::find(frame.columns.begin(), frame.columns.end(), "element");
    if (element == frame.columns.end()) return std::nullopt;
    return Names{cursor.place(), frame.rows, static_cast<std::size_t>(element - frame.columns.begin())};
  }

  /// Whether the types of atoms are labels, as with `dump_modify types labels`: the first one is not a number.
  ///
  /// `rows`     at the first row
  static bool has_labels(const LammpsFrame& frame, TextCursor rows) {
    const auto type = std::find(frame.columns.begin(), frame.columns.end(), "type");
    std::string row;
    if (type == frame.columns.end() || frame.rows == 0 || !rows.next(row)) return false;
    const auto words = words_of(row);
    const auto column = static_cast<std::size_t>(type - frame.columns.begin());
    std::int64_t ignored = 0;
    return column < words.size() && !parse_integer(words[column], ignored);
  }

  /// The header of a frame, and the cursor at its rows.
  std::pair<LammpsFrame, TextCursor> header(int number) {
    TextCursor cursor = frame(number);
    Faults faults(bytes().file());
    LammpsFrame header = read_lammps_frame(cursor, faults);
    header.has_labels = has_labels(header, cursor);
    const std::uint64_t line = cursor.line() - 1;
    if (!contain(header.columns, kAxes) && !contain(header.columns, kUnwrapped) && scaled_position(header) == nullptr)
      faults.fail(line, "no columns with positions", "write x y z, xu yu zu, xs ys zs or xsu ysu zsu");
    if (scaled_position(header) != nullptr && !header.box)
      faults.fail(line, "positions are scaled, but the frame has no item \"BOX BOUNDS\"");
    return {std::move(header), cursor};
  }
};

/// Binary dumps since 2020 begin with a negative length and the style; older ones have no signature.
bool is_binary(std::string_view head) {
  return head.substr(0, 32).find("DUMPATOM") == 8 || head.substr(0, 32).find("DUMPCUSTOM") == 8;
}

}  // namespace

bool is_lammps_dump(const Signature& signature) {
  return signature.head.starts_with("ITEM:") || is_binary(signature.head);
}

std::unique_ptr<DataFile> open_lammps_dump(const Bytes& bytes, const OpenOptions&) {
  constexpr std::size_t kSignatureBytes = 32;
  if (is_binary(bytes->text(0, kSignatureBytes)))
    Faults(bytes->file())
        .fail(0, "binary LAMMPS dumps are not supported",
              "convert it with the tool binary2txt of LAMMPS, or write a text dump, which may be compressed: *.gz, "
              "*.zst");
  return std::make_unique<LammpsDump>(bytes);
}

}  // namespace orrery::rows
