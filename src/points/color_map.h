// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "math/vec3.h"

namespace orrery::points {

using math::Vec3d;

/// A colour map: from [0, 1] to display-referred sRGB, linear between knots; or a set of colours for categories.
struct ColorMap {
  struct Knot {
    double t = 0;  ///< 0 at the first knot, 1 at the last, ascending
    Vec3d srgb;    ///< display-referred sRGB
  };

  std::string name;
  bool is_categorical = false;
  std::vector<Knot> knots;  ///< at least 2; for a categorical map, its colours (t is ignored)
};

/// Returns the built-in colour map with a name; null if there is none.
///
/// Precision  within 1/255 of the published tables; tools/color_maps.py measures it
/// Reference  docs/references.md, colour maps
const ColorMap* find_color_map(std::string_view name);

/// Returns a colour 0xRRGGBB as components of 0 to 255.
Vec3d bytes_of(std::uint32_t code);

/// The colour `#rrggbb`, 0 to 255; none for other text.
std::optional<Vec3d> parse_hex(std::string_view text);

/// The colour with a name, such as `grey`, or in the form #rrggbb or #rgb, as a display shows it.
///
/// Result     linear Rec.709
/// Errors     base::Error(kUsage)
Vec3d parse_color(const std::string& text);

/// Returns the names of the built-in colour maps, the categorical ones last.
const std::vector<std::string>& color_map_names();

/// Returns the colour at t in display-referred sRGB. Outside [0, 1], the first or last colour; for n categorical
/// colours, number floor(t n).
///
/// Domain     t is not NaN
Vec3d srgb_at(const ColorMap& map, double t);

/// Returns the colours at t = i / (count - 1) as scene-linear Rec.709. A categorical map repeats its colours.
std::vector<Vec3d> palette(const ColorMap& map, std::size_t count);

/// Decodes display-referred sRGB to scene-linear Rec.709.
Vec3d linear_from_srgb(Vec3d srgb);

/// Encodes scene-linear Rec.709, 0 to 1, as display-referred sRGB.
Vec3d srgb_from_linear(Vec3d linear);

/// Reads a colour map from a text file. Each line is a colour: `r g b`, or `t r g b` with ascending t, or `#rrggbb`.
/// Numbers are separated by spaces or commas. If any of r, g, b is greater than 1, all are in 0..255. Blank lines and
/// lines that begin with `#`, except colours, are skipped.
///
/// Result     a continuous map, named after the file
/// Errors     base::Error: kMissingInput, kIo; kBadData with the lines
ColorMap read_color_map(const std::filesystem::path& file);

/// The values along a colour map.
class ValueScale {
 public:
  /// `is_log`   equal steps are those of logarithms; both ends are above 0
  /// Domain     finite ends in any order
  ValueScale(double first, double last, bool is_log = false);

  /// The position of a value: 0 at the first to 1 at the last; 0.5 if both are equal.
  ///
  /// Domain     above 0 if the scale is logarithmic; not NaN
  double share_of(double value) const;

  double first() const { return first_; }
  double last() const { return last_; }
  bool is_log() const { return is_log_; }

 private:
  double first_, last_;
  bool is_log_;
  double from_, to_;  ///< the ends, or their logarithms
  double unit_;       ///< by which these are multiplied, so that their difference is finite
};

/// A knot of a colour map: index in its published table of 256 entries, and display-referred sRGB.
struct ColorMapRow {
  std::uint8_t index;
  double r, g, b;
};

struct ContinuousTable {
  const char* name;
  std::span<const ColorMapRow> rows;
};

struct CategoricalTable {
  const char* name;
  std::span<const std::uint32_t> colors;  ///< 0xRRGGBB
};

extern const std::span<const ContinuousTable> kContinuousTables;
extern const std::span<const CategoricalTable> kCategoricalTables;

}  // namespace orrery::points
