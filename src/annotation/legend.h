// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "annotation/drawing.h"
#include "display/forward.h"
#include "points/color_map.h"
#include "scene/scene.h"

namespace orrery::annotation {

struct Tick {
  double value = 0;
  std::string label;
};

/// Returns ticks at multiples of 1, 2 or 5 times a power of ten in a range, with as many digits as distinguish them.
/// All labels are fixed ("0.25"), or, if the range reaches 1e6 or is below 1e-3, scientific with a common exponent
/// ("0.5e-7").
///
/// `least`    least distance of ticks, as a share of the range
/// Domain     finite ends in any order
/// Result     by default 4 to 11 ascending ticks; one if the ends are equal or too close to be distinguished; the ends
/// if their
///            difference is not finite
std::vector<Tick> nice_ticks(double first, double last, double least = 0.1);

/// Returns the ticks of a scale: nice_ticks(), or on a logarithmic one of at least a decade powers of ten, with their
/// double and fivefold on less than three decades.
std::vector<Tick> ticks_of(const points::ValueScale& scale, double least = 0.1);

/// Orders numbers by value, before other strings.
struct LabelOrder {
  bool operator()(std::string_view a, std::string_view b) const;
};

/// The colours of points tables, collected over frames. All are linear Rec.709.
struct LegendColors {
  std::string title;                                ///< the column, "type" or "element"
  std::map<std::string, Vec3d, LabelOrder> labels;  ///< colours of types, elements and categories
  std::vector<Vec3d> bar;                           ///< colours of a colour map; empty: there is none
  std::optional<Vec3d> nan_color;                   ///< set if a value is NaN
  std::optional<scene::Interval> range;             ///< range of the colour map
  bool is_log = false;                              ///< the map is logarithmic
  bool has_conflict = false;                        ///< a label has different colours in different frames

  bool is_empty() const { return labels.empty() && (bar.empty() || !range); }
  /// Adds the colours of a loaded frame, of which `palette` is linear Rec.709.
  void add(const scene::Points& frame, const std::vector<Vec3d>& palette);
};

/// The first bytes of a text, at most so many, and an ellipsis if there are more.
std::string shortened(const std::string& text, std::size_t most_bytes);

/// How a legend is drawn.
struct LegendStyle {
  double font_px = 0;
  double height_px = 0;         ///< at most
  std::size_t most_labels = 0;  ///< of further ones, the number is shown
  std::size_t most_bytes = 0;   ///< of a text; the rest is cut off
  Vec3d ink{0, 0, 0};           ///< of text, ticks and frames
};

/// Lays out a legend: a title, then a bar with ticks, or patches with labels. Long texts are truncated.
///
/// Domain     colours that are not empty
/// Errors     those of image::text_widths()
Drawing legend_drawing(const LegendColors& colors, const LegendStyle& style, const std::filesystem::path& font);

/// The colours as a display shows them, 0..1.
LegendColors shown_colors(LegendColors colors, const display::Settings& display);

/// Writes the legend of a plot's colours as SVG or as an image. Applies the display transform of the plot's images, so
/// that the colours match.
///
/// `display`  display transform of the images; its working space is not used
/// Errors     base::Error: kUsage for another extension, if there are no colours, and for an image of too many labels;
///            those of legend_drawing(); kCannotCreate, kIo
void write_legend(const std::filesystem::path& file, const LegendColors& colors, const display::Settings& display);

}  // namespace orrery::annotation
