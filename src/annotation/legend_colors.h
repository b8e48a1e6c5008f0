// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "display/forward.h"
#include "scene/scene.h"

namespace orrery::annotation {

/// Orders numbers by value, before other strings.
struct LabelOrder {
  bool operator()(std::string_view a, std::string_view b) const;
};

/// The colours of points tables, collected over frames. All are linear Rec.709.
struct LegendColors {
  std::string title;                                      ///< the column, "type" or "element"
  std::map<std::string, math::Vec3d, LabelOrder> labels;  ///< colours of types, elements and categories
  std::vector<math::Vec3d> bar;                           ///< colours of a colour map; empty: there is none
  std::optional<math::Vec3d> nan_color;                   ///< set if a value is NaN
  std::optional<scene::Interval> range;                   ///< range of the colour map
  bool is_log = false;                                    ///< the map is logarithmic
  bool has_conflict = false;                              ///< a label has different colours in different frames

  /// Adds the colours of a loaded frame.
  void add(const scene::Points& frame);
};

/// The legend of a plot's colours as SVG; empty if there are neither labels nor a colour map with a range.
///
/// `display`  see write_legend()
/// Errors     those of display::develop
std::string legend_svg(const LegendColors& colors, const display::Settings& display);

/// Writes the legend of a plot's colours as SVG or as an image. Applies the display transform of the plot's images, so
/// that the colours match.
///
/// `display`  display transform of the images; its working space is not used
/// Errors     base::Error: kUsage for another extension, and if there are neither labels nor a colour map with a range;
///            those of display::develop; kCannotCreate, kIo
void write_legend(const std::filesystem::path& file, const LegendColors& colors, const display::Settings& display);

}  // namespace orrery::annotation
