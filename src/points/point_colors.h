// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "data/table.h"
#include "points/color_map.h"
#include "points/rows.h"
#include "points/selection.h"
#include "scene/scene.h"

namespace orrery::points {

/// How the colours of a file's spheres are determined: one of the alternatives of scene::PointsColor.
struct ColorSource {
  enum class Kind { kNone, kMap, kElement, kType, kRgb };
  Kind kind = Kind::kNone;
  std::vector<std::string> columns;      ///< columns to read
  std::optional<Expression> expression;  ///< kMap: of these columns; none: the column itself
  double rgb_maximum = 255;
  std::optional<ColorMap> map;
};

/// Colours of spheres: a palette and one index per sphere.
struct PointColors {
  std::vector<math::Vec3d> palette;
  std::size_t rec709 = 0;  ///< leading colours that are linear Rec.709; the others are in the scene's colour space
  std::vector<std::uint16_t> indices;
  std::vector<std::string> names;        ///< names of the colours, if they represent types, elements or strings
  std::optional<scene::Interval> range;  ///< range of a continuous colour map; empty if all values are NaN
};

/// Determines the source of the colours. Reports unknown columns and maps, and mutually exclusive keys.
///
/// `folder`   folder of the scene file, for a map in a file
/// Errors     base::Error: those of read_color_map()
ColorSource color_source(const data::FrameInfo& info, const scene::PointsColor& color,
                         const std::filesystem::path& folder, KeyFaults& faults);

/// Adds the values of the source's expression, if it has one, to a table as the column scene::PointsColor::column.
/// Those that are not finite become NaN, and are counted in a warning.
void add_expression(const ColorSource& source, const scene::PointsColor& color, data::Table& table, KeyFaults& faults);

/// Calls `f(value)` for each value of a column that a continuous map shows: finite, and above 0 if `is_log`.
template <class F>
void for_each_shown(const data::Column& column, const Rows& rows, bool is_log, F f) {
  for_each_number(column, rows, [&](std::size_t, double v) {
    if (std::isfinite(v) && (v > 0 || !is_log)) f(v);
  });
}

/// Returns the colours of the rows. A map becomes 256 colours. More than 65,536 distinct RGB colours are reduced to 7,
/// 6 or 5 bits per channel, whichever fits.
///
/// Domain     a table with the source's columns, after add_expression()
PointColors colors_of(const data::Table& table, const Rows& rows, const ColorSource& source,
                      const scene::PointsColor& color, KeyFaults& faults);

}  // namespace orrery::points
