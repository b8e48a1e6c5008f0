// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "data/table.h"
#include "points/color_map.h"
#include "scene/scene.h"

namespace orrery::points {

/// How the colours of a file's spheres are determined: one of the alternatives of scene::PointsColor.
struct ColorSource {
  enum class Kind { kNone, kMap, kElement, kType, kRgb };
  Kind kind = Kind::kNone;
  std::vector<std::string> columns;  ///< columns to read
  double rgb_maximum = 255;
  std::optional<ColorMap> map;
};

class KeyFaults;
class Rows;

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

/// Returns the colours of the rows. A map becomes 256 colours. More than 65,536 distinct RGB colours are reduced to 7,
/// 6 or 5 bits per channel, whichever fits.
///
/// Domain     a table with the source's columns
PointColors colors_of(const data::Table& table, const Rows& rows, const ColorSource& source,
                      const scene::PointsColor& color, KeyFaults& faults);

}  // namespace orrery::points
