// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "points/color_map.h"
#include "points/copies.h"
#include "points/rows.h"
#include "points/rules.h"
#include "points/selection.h"
#include "scene/forward.h"

/// How the radii, colours, opacities and labels of a file's spheres are determined. A source says which columns have to
/// be read; when they have been, it gives the values.
namespace orrery::points {

/// How the radii of a file's spheres are determined: one of the alternatives of scene::PointsRadius, or the file's own.
struct RadiusSource {
  enum class Kind { kValue, kColumn, kElement, kType };
  Kind kind = Kind::kValue;
  std::string column;               ///< column to read; empty: none
  double scale = 1;                 ///< multiplies column and element radii
  std::vector<Rule<double>> rules;  ///< see scene::PointsRadius::where
};

/// Determines the source of the radii. Reports a missing radius, unknown columns, and mutually exclusive keys.
RadiusSource radius_source(const data::FrameInfo& info, const scene::PointsRadius& radius, KeyFaults& faults);

/// Returns the radii of the rows, of a table with the source's column. Reports elements and types without a radius.
scene::NumberArray radii_of(const data::Table& table, const Rows& rows, const RadiusSource& source,
                            const scene::PointsRadius& radius, KeyFaults& faults);

/// Keeps the rows whose centres and radii are finite, and whose radii are above 0. Reports the others, as errors unless
/// `points.skip_bad`, and spheres that are outside the domain of scenes, while their rows are known.
///
/// `may_be_hollow`  accepts radii below 0
/// Result           unchanged after an error
void keep_valid(const scene::PointsKeys& points, bool may_be_hollow, Rows& rows, scene::PointArray& centers,
                scene::NumberArray& radii, KeyFaults& faults);

/// How the colours of a file's spheres are determined: one of the alternatives of scene::PointsColor.
struct ColorSource {
  enum class Kind { kNone, kMap, kElement, kType, kRgb };
  Kind kind = Kind::kNone;
  std::vector<std::string> columns;      ///< columns to read
  std::optional<Expression> expression;  ///< kMap: of these columns; none: the column itself
  double rgb_maximum = 255;
  std::optional<ColorMap> map;
  std::vector<Rule<Vec3d>> rules;  ///< see scene::PointsColor::where; linear Rec.709

  /// Whether spheres have colours of their own.
  bool is_set() const { return kind != Kind::kNone || !rules.empty(); }
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

/// Sets the colours of the rows: `points.colors`, the palette and what is known of it. A map becomes 256 colours. More
/// than 65,536 distinct RGB colours are reduced to 7, 6 or 5 bits per channel, whichever fits.
///
/// Domain     a table with the source's columns, after add_expression(); points without data
void set_colors(const data::Table& table, const Rows& rows, const ColorSource& source, scene::Points& points,
                KeyFaults& faults);

/// How the opacities of a file's spheres are determined.
struct OpacitySource {
  std::string column;              ///< of opacities or of types; empty: none
  std::vector<Rule<float>> rules;  ///< see scene::PointsOpacity::where

  /// Whether spheres have opacities of their own.
  bool is_set() const { return !column.empty() || !rules.empty(); }
};

/// Determines the source of the opacities. Reports unknown columns, rules that are not valid, and mutually exclusive
/// keys.
OpacitySource opacity_source(const data::FrameInfo& info, const scene::PointsOpacity& opacity, KeyFaults& faults);

/// Returns the opacities of the rows, as scene::Points::opacities, for a source that is set. Reports values of a column
/// outside 0..1 in rows that match no rule.
std::vector<float> opacities_of(const data::Table& table, const Rows& rows, const OpacitySource& source,
                                const scene::PointsKeys& points, KeyFaults& faults);

/// The text of a rule of scene::PointsKeys::labels.
///
/// Errors     base::Error(kUsage) if it is empty
std::string parse_label(const std::string& text);

/// Places each label at the middle of the rows that match, in the first copy of the particles. Reports labels that
/// match none, and omits them.
std::vector<scene::Label> placed_labels(const data::Table& table, const Rows& rows, const scene::PointArray& centers,
                                        const std::vector<Rule<std::string>>& rules, const Copy& first,
                                        const scene::PointsKeys& points, KeyFaults& faults);

/// The columns of the velocities by which spheres move; empty: they move to the next frame. Reports keys that exclude
/// or need each other, and unknown columns.
///
/// Domain     `motion` is set
std::vector<std::string> velocity_columns(const data::FrameInfo& info, const scene::PointsMotion& motion,
                                          KeyFaults& faults);

/// The differences between the places of particles in another frame and in this one, to the nearest images in the
/// periodic box. Particles are found by their ids, or, without ids, by their order. Reports those that are not found,
/// which rest, and those that move so far that another image may be the right one.
///
/// `rows`     ascending by id, of `table`, with their `centers`; its frame is described by `info`
/// `roles`    of the other frame, whose table has the columns of positions and ids
scene::PointArray displacements(const data::Table& table, const Rows& rows, const scene::PointArray& centers,
                                const data::FrameInfo& info, const data::Table& other, const data::Roles& roles,
                                KeyFaults& faults);

/// Returns the displacements of the rows in a frame, times a factor, in single precision. Reports those that are not
/// finite or too large, as errors unless `points.skip_bad`.
scene::PointArray valid_displacements(const scene::PointsKeys& points, const Rows& rows,
                                      const scene::PointArray& displacements, double factor, KeyFaults& faults);

/// Moves the spheres, with their bonds, by their displacement in a time.
void advance(scene::Points& points, double frames);

/// Returns the type of a column of a frame.
data::ColumnType type_of(const data::FrameInfo& info, const std::string& column);

/// Upper bound of the size of a sphere's centre and radius as scene data, bytes. Numbers that do not need double
/// precision are stored as floats.
///
/// `are_rounded`   whether make_copies() rounds the centres
std::uint64_t bytes_per_sphere(const data::FrameInfo& info, const scene::PointsKeys& points, const RadiusSource& radius,
                               bool are_rounded);

/// Checks that there is enough memory to read the spheres of a data file.
///
/// `spheres`  number of spheres in all images, which may exceed 64 bits; 0: not known yet
/// `bytes`    memory that is needed
/// `limit`    bytes; 0: none
/// Errors     base::Error(kNoMemory) with the needed size
void require_memory(const std::filesystem::path& file, std::uint64_t rows, double spheres, double bytes,
                    std::uint64_t limit);

}  // namespace orrery::points
