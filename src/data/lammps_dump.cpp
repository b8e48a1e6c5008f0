// SPDX-License-Identifier: Apache-2.0
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "data/lammps_frame.h"
#include "data/readers.h"
#include "data/text_cursor.h"
#include "data/text_rows.h"

namespace orrery::data {
namespace {

using Axes = std::array<std::string, 3>;

const Axes kAxes = {"x", "y", "z"};
const Axes kUnwrapped = {"xu", "yu", "zu"};
const Axes kScaled = {"xs", "ys", "zs"};
const Axes kScaledUnwrapped = {"xsu", "ysu", "zsu"};

bool contains(const std::vector<std::string>& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

bool contains(const std::vector<std::string>& names, const Axes& axes) {
  return std::all_of(axes.begin(), axes.end(), [&](const std::string& axis) { return contains(names, axis); });
}

ColumnType type_of(std::string_view column) {
  constexpr std::string_view kIntegers[] = {"id", "type", "mol", "ix", "iy", "iz", "proc", "procp1"};
  if (column == "element" || column == "typelabel") return ColumnType::kText;
  return std::find(std::begin(kIntegers), std::end(kIntegers), column) != std::end(kIntegers) ? ColumnType::kInt64
                                                                                              : ColumnType::kFloat64;
}

/// The scaled columns from which positions are computed; null if the file has positions.
const Axes* scaled_position(const LammpsFrame& frame) {
  if (contains(frame.columns, kAxes) || contains(frame.columns, kUnwrapped)) return nullptr;
  if (contains(frame.columns, kScaled)) return &kScaled;
  return contains(frame.columns, kScaledUnwrapped) ? &kScaledUnwrapped : nullptr;
}

FrameInfo described(const LammpsFrame& frame) {
  FrameInfo info;
  info.rows = frame.rows;
  info.box = frame.box;
  info.step = frame.step;
  for (const std::string& column : frame.columns) info.columns.push_back({column, type_of(column)});
  if (scaled_position(frame) != nullptr)
    for (const std::string& axis : kAxes)
      if (!contains(frame.columns, axis)) info.columns.push_back({axis, ColumnType::kFloat64});
  const auto if_there = [&](const char* name) { return contains(frame.columns, name) ? name : std::string(); };
  Roles& roles = info.roles;
  roles.position = scaled_position(frame) != nullptr || contains(frame.columns, kAxes) ? kAxes : kUnwrapped;
  roles.radius = if_there("radius");
  if (roles.radius.empty() && contains(frame.columns, "diameter")) {
    roles.radius = "diameter";
    roles.radius_scale = 0.5;
  }
  roles.element = if_there("element");
  roles.type = contains(frame.columns, "type") ? "type" : if_there("typelabel");
  roles.id = if_there("id");
  if (contains(frame.columns, Axes{"ix", "iy", "iz"})) roles.image = {"ix", "iy", "iz"};
  return info;
}

class LammpsDump final : public DataFile {
 public:
  explicit LammpsDump(Bytes bytes) : bytes_(std::move(bytes)), end_(*bytes_) {}

  Format format() const override { return Format::kLammpsDump; }

  int frame_count() override {
    while (add_frame()) {
    }
    return static_cast<int>(frames_.size());
  }

  FrameInfo describe(int frame) override { return described(header(frame).first); }

  Table read(int number, const std::vector<std::string>& columns) override {
    const auto [frame, cursor] = header(number);
    const Axes* const scaled = scaled_position(frame);
    const auto is_computed = [&](const std::string& name) {
      return scaled != nullptr && std::find(kAxes.begin(), kAxes.end(), name) != kAxes.end();
    };
    const bool needs_scaled = std::any_of(columns.begin(), columns.end(), is_computed);
    TextLayout layout;
    layout.begin = cursor.offset();
    layout.rows = frame.rows;
    layout.first_line = cursor.line();
    for (const std::string& name : frame.columns) {
      const bool is_scaled = needs_scaled && std::find(scaled->begin(), scaled->end(), name) != scaled->end();
      const bool is_wanted = !is_computed(name) && std::find(columns.begin(), columns.end(), name) != columns.end();
      layout.columns.push_back({type_of(name), is_wanted || is_scaled});
    }
    Faults faults(bytes_->file());
    TextTable text = read_text_rows(*bytes_, layout, faults);
    require_end_of_frame(TextCursor(*bytes_, text.end, layout.first_line + text.rows), frame);
    return taken(columns, frame, std::move(text));
  }

 private:
  struct Entry {
    std::uint64_t offset;
    std::uint64_t line;
  };

  /// Extends the index by a frame.
  ///
  /// Result     false if there are no more
  bool add_frame() {
    std::string line;
    for (TextCursor ahead = end_;; end_ = ahead) {
      if (!ahead.next(line)) {
        if (frames_.empty()) Faults(bytes_->file()).fail(end_.line(), "the file has no frames");
        return false;
      }
      if (line.find_first_not_of(" \t") != std::string::npos) break;
    }
    const Entry entry{end_.offset(), end_.line()};
    Faults faults(bytes_->file());
    // A frame with too few rows is reported when it is read: those before it are usable.
    end_.skip(read_lammps_frame(end_, faults).rows);
    frames_.push_back(entry);
    return true;
  }

  /// The header of a frame, and the cursor at its rows.
  std::pair<LammpsFrame, TextCursor> header(int number) {
    const auto index = static_cast<std::size_t>(number);
    while (frames_.size() <= index && add_frame()) {
    }
    TextCursor cursor(*bytes_, frames_.at(index).offset, frames_[index].line);
    Faults faults(bytes_->file());
    LammpsFrame frame = read_lammps_frame(cursor, faults);
    const std::uint64_t line = cursor.line() - 1;
    if (!contains(frame.columns, kAxes) && !contains(frame.columns, kUnwrapped) && scaled_position(frame) == nullptr)
      faults.fail(line, "no columns with positions", "write x y z, xu yu zu, xs ys zs or xsu ysu zsu");
    if (scaled_position(frame) != nullptr && !frame.box)
      faults.fail(line, "positions are scaled, but the frame has no item \"BOX BOUNDS\"");
    return {std::move(frame), cursor};
  }

  void require_end_of_frame(TextCursor cursor, const LammpsFrame& frame) const {
    std::string line;
    while (cursor.next(line)) {
      if (line.starts_with("ITEM:")) return;
      if (line.find_first_not_of(" \t") != std::string::npos)
        Faults(bytes_->file())
            .fail(cursor.line() - 1, "expected the end of the frame after " + std::to_string(frame.rows) + " rows",
                  "check the number of atoms in line " + std::to_string(frame.rows_line));
    }
  }

  static Table taken(const std::vector<std::string>& columns, const LammpsFrame& frame, TextTable text) {
    Table table;
    table.rows = text.rows;
    const auto index = [&](const std::string& name) {
      return static_cast<std::size_t>(std::find(frame.columns.begin(), frame.columns.end(), name) -
                                      frame.columns.begin());
    };
    const Axes* const scaled = scaled_position(frame);
    for (const std::string& name : columns) {
      const auto axis = static_cast<std::size_t>(std::find(kAxes.begin(), kAxes.end(), name) - kAxes.begin());
      if (scaled == nullptr || axis == kAxes.size()) continue;
      std::array<const double*, 3> s;
      for (std::size_t i = 0; i < 3; ++i) s[i] = std::get<std::vector<double>>(text.values[index((*scaled)[i])]).data();
      std::vector<double> values(text.rows);
      const auto part = [axis](const Vec3d& v) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; };
      const double origin = part(frame.box->origin);
      const std::array<double, 3> edges = {part(frame.box->edges[0]), part(frame.box->edges[1]),
                                           part(frame.box->edges[2])};
      tbb::parallel_for(tbb::blocked_range<std::size_t>(0, values.size(), std::size_t{1} << 16),
                        [&](const auto& range) {
                          for (std::size_t i = range.begin(); i < range.end(); ++i)
                            values[i] = origin + s[0][i] * edges[0] + s[1][i] * edges[1] + s[2][i] * edges[2];
                        });
      table.columns.push_back({name, std::move(values)});
    }
    for (const std::string& name : columns)
      if (table.find(name) == nullptr) table.columns.push_back({name, std::move(text.values[index(name)])});
    return table;
  }

  Bytes bytes_;
  std::vector<Entry> frames_;  ///< those found so far
  TextCursor end_;             ///< behind them
};

/// Binary dumps since 2020 begin with a negative length and the style; older ones have no signature.
bool is_binary(std::string_view head) {
  return head.substr(0, 32).find("DUMPATOM") == 8 || head.substr(0, 32).find("DUMPCUSTOM") == 8;
}

}  // namespace

bool is_lammps_dump(const Signature& signature) {
  return signature.head.starts_with("ITEM:") || is_binary(signature.head);
}

std::unique_ptr<DataFile> open_lammps_dump(const Bytes& bytes) {
  constexpr std::size_t kSignatureBytes = 32;
  if (is_binary(bytes->text(0, kSignatureBytes)))
    Faults(bytes->file())
        .fail(0, "binary LAMMPS dumps are not supported",
              "convert it with the tool binary2txt of LAMMPS, or write a text dump, which may be compressed: *.gz, "
              "*.zst");
  return std::make_unique<LammpsDump>(bytes);
}

}  // namespace orrery::data
