// SPDX-License-Identifier: Apache-2.0
#include "plot/appearance.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include <fmt/core.h>

#include "base/error.h"
#include "base/text.h"
#include "data/columns.h"
#include "plot/plot.h"
#include "plot/range.h"
#include "plot/settings.h"
#include "points/bonds.h"
#include "points/color_map.h"
#include "points/sources.h"
#include "scene/layers.h"
#include "scene/value_text.h"

namespace orrery::plot {
namespace {

using scene::number_text;

/// Colour map of numbers, and of categories.
constexpr const char* kMap = "fast";
constexpr const char* kCategoricalMap = "set2";

/// Colours by element, but of carbons by the column before this.
constexpr const char* kWithElements = "+element";

/// Atoms from which colours by element are noise, and chains are shown instead.
constexpr std::uint64_t kManyAtoms = 5000;

/// Neighbours at the distance of covalent bonds, of an atom on average: fewer in molecules, more in metals, salts and
/// other networks, in which van der Waals radii would bury all but the surface.
constexpr double kNetworkCoordination = 2.5;

/// Radius of the spheres of a ball-and-stick model or of sticks without elements, as a fraction of that of spheres;
/// radius of sticks between elements, in the unit of the file.
constexpr double kBallFraction = 0.5, kStickFraction = 0.3, kStickRadius = 0.2;

/// Radius of a trace that is all there is, angstrom.
constexpr double kTraceRadius = 1.2;

/// Length of arrows and radius of their shafts, in distances to the nearest neighbour; radius of spheres with arrows,
/// as a fraction of that without.
constexpr double kArrowLength = 1.2, kShaftRadius = 0.07, kArrowSphereFraction = 0.25;

constexpr const char* kRadiusRemedy = "; --radius changes it";

/// Whether a column numbers groups of particles, so that close numbers mean nothing, by its name.
bool is_group(const std::string& column, const data::Roles& roles) {
  const std::string name = base::lower(column);
  return name != base::lower(roles.id) &&
         (name.ends_with("_id") ||
          base::contains({"mol", "molecule", "molid", "cluster", "grain", "body", "group"}, name));
}

/// Makes the choices, one after another.
class Appearance {
 public:
  Appearance(const PlotOptions& options, const DataFrames& data, scene::PointsKeys& points)
      : options_(options), data_(data), info_(data.info()), points_(points) {}

  std::vector<std::string> run() {
    // Determining the radius from the spacing requires reading the file, so the colour options are checked first.
    const std::vector<std::string> color_choices = choose_color();
    name_components("--vectors", points_.vectors.columns);
    name_components("--velocity", points_.motion.columns);
    choose_motion();
    choose_representation();
    if (!points_.vectors.columns.empty() && options_.material == "glass")
      base::refuse("--vectors: arrows of glass are not supported; use another --material");
    choose_radius();
    choose_bonds();
    choose_arrows();
    choices_.insert(choices_.end(), color_choices.begin(), color_choices.end());
    return std::move(choices_);
  }

 private:
  /// Measures the file at the first call, for all choices: radii if they determine something, the spacing otherwise and
  /// for arrows.
  const Measures& measured(bool by_radii) {
    if (!measures_) measures_ = data_.measures(points_, !by_radii || !points_.vectors.columns.empty(), by_radii);
    return *measures_;
  }

  /// Replaces the one name of a vector by its components: `forces` by forces[1] to forces[3], `v` by vx, vy and vz.
  void name_components(const char* option, std::vector<std::string>& columns) {
    if (columns.size() != 1) return;
    const std::string name = columns.front();
    using Three = std::array<std::string, 3>;
    for (const Three& ends : {Three{"[1]", "[2]", "[3]"}, Three{"_x", "_y", "_z"}, Three{"x", "y", "z"}}) {
      columns.clear();
      for (const std::string& end : ends)
        if (data::find_named(info_.columns, name + end) != nullptr) columns.push_back(name + end);
      if (columns.size() == 3) return;
    }
    base::refuse(
        fmt::format("{0} {1}: there are no columns {1}[1] to {1}[3]; name three, e.g. vx,vy,vz", option, name));
  }

  /// Particles move if the shutter is open, or motion vectors are requested: to the next frame, unless the user names
  /// velocities or the time between frames.
  void choose_motion() {
    scene::PointsMotion& motion = points_.motion;
    const bool is_open = options_.shutter > 0 || options_.overrides.sets("camera.shutter_close");
    const bool has_vectors =
        options_.overrides.sets("output.layers") &&
        base::contains(settings_scene(options_, false).read.scene.output.layers, scene::kVectorLayer);
    if (motion.is_set() && !is_open && !has_vectors)
      base::refuse("--velocity and --frame-time have no effect without --shutter X or --layers Vector");
    if (motion.is_set() && !motion.frame_time)
      base::refuse("--velocity: how far particles move depends on the time between frames; add --frame-time T");
    if (motion.is_set() || !(options_.shutter > 0 || has_vectors)) return;
    motion.next_frame = data_.has_several();
    if (motion.next_frame)
      chose("motion to the next frame", "the nearest periodic image; --frame-time T takes velocities instead");
    else if (options_.shutter > 0)
      base::refuse(
          "--shutter: the file has one frame; add --frame-time T, the time between frames, to move particles by their "
          "velocities");
  }

  void chose(const std::string& what, const std::string& why) { choices_.push_back(fmt::format("{}: {}", what, why)); }

  /// Atoms of a trace alone are drawn as one. Representations of some particles leave the radii of the others.
  void choose_representation() {
    std::vector<std::string>& rules = points_.representation;
    if (options_.representation) {
      representation_ = *options_.representation;
    } else if (shows_cell(options_, info_)) {
      representation_ = Representation::kBallAndStick;
      chose("representation ball-and-stick", "the unit cell of a crystal; --representation spheres shows atoms alone");
    } else if (rules.empty() && !options_.bonds && points_.vectors.columns.empty() &&
               data::has_column(info_.columns, "name") && data::has_column(info_.columns, "residue_number") &&
               !info_.roles.chain.empty()) {
      const std::vector<std::string> names = data_.distinct_values(points_, "name");
      if (names == std::vector<std::string>{"CA"} || names == std::vector<std::string>{"P"}) {
        representation_ = Representation::kTrace;
        if (!has_radius()) points_.radius.value = rounded(kTraceRadius * points_.radius.scale);
        chose("representation trace", "all atoms are " + names[0] + " atoms; --representation spheres shows them");
      }
    }
    const bool has_keys = representation_ == Representation::kTrace || representation_ == Representation::kPoints;
    if (!has_keys && rules.empty()) return;
    if (representation_ != Representation::kSpheres)
      rules.insert(rules.begin(), representation_names()[static_cast<std::size_t>(representation_)]);
    representation_ = Representation::kSpheres;
  }

  bool has_radius() const {
    const scene::PointsRadius& radius = points_.radius;
    return radius.value || !radius.column.empty() || !radius.element.empty() || !radius.types.empty();
  }

  void choose_radius() {
    scene::PointsRadius& radius = points_.radius;
    if (has_radius()) return;
    const bool has_elements = !info_.roles.element.empty();
    const bool is_spheres = representation_ == Representation::kSpheres;
    const bool is_sticks = representation_ == Representation::kSticks;
    const bool has_arrows = !points_.vectors.columns.empty() && is_spheres;
    const double fraction = has_arrows   ? kArrowSphereFraction
                            : is_spheres ? 1
                            : is_sticks  ? kStickFraction
                                         : kBallFraction;
    const std::string why = has_arrows ? fmt::format(", times {} beside arrows", number_text(fraction))
                            : is_spheres
                                ? ""
                                : fmt::format(", times {} for {}", number_text(fraction),
                                              representation_names()[static_cast<std::size_t>(representation_)]);
    if (is_sticks && has_elements) {
      radius.value = rounded(kStickRadius * radius.scale);
      chose("radius " + number_text(*radius.value), std::string("that of sticks") + kRadiusRemedy);
    } else if (!info_.roles.radius.empty()) {
      if (fraction != 1) {
        radius.column = info_.roles.radius;
        radius.scale *= info_.roles.radius_scale * fraction;
      }
      chose("radius of the file", (info_.roles.radius_scale == 1 ? "the column " : "half of the column ") +
                                      info_.roles.radius + why + kRadiusRemedy);
    } else if (has_elements) {
      const bool is_full = is_spheres && !has_arrows;
      if (is_full && data_.mean_coordination(points_) > kNetworkCoordination) return choose_network_radius();
      radius.element = is_full ? "vdw" : "ball";
      chose("radius " + radius.element,
            fmt::format("{}van der Waals radii of the elements{}", is_full ? "" : "a quarter of the ", kRadiusRemedy));
    } else {
      radius.value = 1;
      const double distance = measured(false).spacing;
      if (distance > 0) radius.value = distance / 2;
      radius.value = rounded(*radius.value * radius.scale * fraction);
      chose("radius " + number_text(*radius.value),
            std::string(distance > 0 ? "half the median distance to the nearest neighbour"
                                     : "no particle has a neighbour") +
                why + (radius.scale == 1 ? "" : "; scaled by " + number_text(radius.scale)) + kRadiusRemedy);
    }
  }

  /// Chooses the radius of atoms that have many neighbours.
  void choose_network_radius() {
    scene::PointsRadius& radius = points_.radius;
    const double distance = measured(false).spacing;
    const std::string why = "a metal, a salt or another network; --element-radii vdw shows full radii";
    if (distance > 0 && data_.distinct_values(points_, info_.roles.element).size() == 1) {
      radius.value = rounded(distance / 2 * radius.scale);
      chose("radius " + number_text(*radius.value), "half the median distance to the nearest neighbour; " + why);
    } else {
      radius.element = "covalent";
      chose("radius covalent", "covalent radii of the elements; " + why);
    }
  }

  /// Sticks have one radius, that of spheres and bonds. The radius of bonds between spheres with a column of radii is
  /// that between all of them, whatever is selected; of sticks, their mean radius.
  void choose_bonds() {
    scene::PointsBonds& bonds = points_.bonds;
    bonds.are_drawn = options_.bonds.value_or(representation_ != Representation::kSpheres);
    if (bonds.are_drawn && representation_ == Representation::kSticks) bonds.radius = points_.radius.value;
    const scene::PointsRadius& radius = points_.radius;
    const bool varies = !radius.value && radius.element.empty() && radius.types.empty();
    if (!bonds.are_drawn || bonds.radius || !varies || !info_.roles.element.empty()) return;
    if (const double mean = measured(true).mean_radius; mean > 0)
      bonds.radius =
          rounded(representation_ == Representation::kSticks ? mean : points::bond_radius(info_, bonds, {mean}));
  }

  /// Arrows of a root mean square vector are somewhat longer than the distance to the nearest neighbour. All frames
  /// and selections have one scale, as they have one radius.
  void choose_arrows() {
    scene::PointsVectors& vectors = points_.vectors;
    if (vectors.columns.empty()) return;
    const double spacing = measured(false).spacing, rms_vector = measured(false).rms_vector;
    if (spacing > 0 && !points_.bonds.are_drawn) vectors.radius = rounded(kShaftRadius * spacing);
    if (!(spacing > 0 && rms_vector > 0)) return;
    vectors.scale = rounded(kArrowLength * spacing / rms_vector);
    chose(fmt::format("arrows {} times {}", number_text(vectors.scale), base::joined(vectors.columns)),
          fmt::format("the root mean square one is {} times the median distance to the nearest neighbour",
                      number_text(kArrowLength)));
  }

  /// The number of particles that the first frame shows.
  std::uint64_t shown_count() const {
    if (options_.points.select.empty() && options_.slices.empty()) return info_.rows;
    scene::PointsKeys keys = points_;
    keys.radius = {};
    keys.radius.value = 1;  // any: the radius is chosen later
    return data_.load(data_.described_frame(), keys).points.particle_count();
  }

  /// Result     the choices, to be printed after those of the radius
  std::vector<std::string> choose_color() {
    scene::PointsColor& color = points_.color;
    const data::Roles& roles = info_.roles;
    std::string by = options_.color_by.empty() && !color.carbon.empty() ? "element" : options_.color_by;
    std::string why;
    std::vector<std::string> out;
    const bool is_glass = options_.material == "glass" && points_.material_where.empty();
    if (is_glass && !by.empty() && by != "none")
      base::refuse(fmt::format("--color-by {} has no effect: glass has no colour; use another --material", by));
    if (by.empty()) {
      const bool may_be_chain = !roles.chain.empty() && !is_glass && roles.rgb[0].empty();
      const bool is_assembly = !options_.points.assembly.empty();
      const bool has_many = may_be_chain && !is_assembly && shown_count() >= kManyAtoms;
      const bool by_chain =
          may_be_chain && (is_assembly || has_many ||
                           (!roles.element.empty() && data_.distinct_values(points_, roles.element).size() == 1));
      by = is_glass                 ? "none"
           : !roles.rgb[0].empty()  ? "rgb"
           : by_chain               ? roles.chain
           : !roles.element.empty() ? "element"
           : !roles.type.empty()    ? "type"
                                    : "none";
      why = is_glass                          ? "glass has none"
            : by == "rgb"                     ? "the file's own; --color-by changes it"
            : by == "none"                    ? "light grey; --color-by COLUMN shows values"
            : by == "element" || by == "type" ? "the file has no colours; --color-by changes it"
            : is_assembly                     ? "an assembly; --color-by element shows elements"
            : has_many                        ? "many atoms; --color-by element shows elements"
                                              : "all atoms are of one element; --color-by element shows it";
      if (may_be_chain && by == "element" && color.carbon.empty() &&
          data_.distinct_values(points_, roles.chain).size() > 1) {
        by = roles.chain + kWithElements;
        why = "several chains; --color-by element shows elements alone";
      }
      out.push_back(fmt::format("{}: {}", by == "none" ? "no colour" : "colour by " + by, why));
    }
    if (set_color(options_, by, info_, color)) {
      const std::string& mapped = color.element.empty() ? color.column : color.carbon;
      const bool is_text = points::type_of(info_, mapped) == data::ColumnType::kText;
      const bool is_categorical = points::find_color_map(color.map)->is_categorical;
      out.push_back(fmt::format("map {}: {}; --map changes it", color.map,
                                is_text          ? fmt::format("colours for categories: {} is text", mapped)
                                : is_categorical ? "colours for categories"
                                                 : "the default for numbers"));
    }
    if (options_.annotation.color_bar && !color.has_legend())
      base::refuse(
          "--color-bar has nothing to explain: the colours are not those of a column, of types or of elements; add "
          "--color-by COLUMN");
    return out;
  }

  const PlotOptions& options_;
  Representation representation_ = Representation::kSpheres;  ///< of all particles
  const DataFrames& data_;
  const data::FrameInfo& info_;
  scene::PointsKeys& points_;
  std::vector<std::string> choices_;
  std::optional<Measures> measures_;
};

}  // namespace

bool shows_cell(const PlotOptions& options, const data::FrameInfo& info) {
  return info.is_unit_cell && !info.roles.element.empty() && !options.representation && !options.bonds &&
         options.points.representation.empty() && options.points.vectors.columns.empty();
}

bool set_color(const DataOptions& options, const std::string& color_by, const data::FrameInfo& info,
               scene::PointsColor& color) {
  const data::Roles& roles = info.roles;
  const bool is_type = color_by == "type", has_range = options.range.is_set || options.points.color.range;
  const bool has_elements = color_by.ends_with(kWithElements);
  if (has_elements) color.carbon = color_by.substr(0, color_by.size() - std::string_view(kWithElements).size());
  if (color.carbon == "chain" && !roles.chain.empty()) color.carbon = roles.chain;
  if (color_by == "rgb" && data::find_named(info.columns, "rgb") == nullptr)
    color.rgb = true;
  else if (has_elements || (color_by == "element" && (!options.has_map || !color.carbon.empty())))
    color.element = "soft";
  else if (color_by != "none")
    color.column = is_type && !roles.type.empty()                    ? roles.type
                   : color_by == "element" && !roles.element.empty() ? roles.element
                                                                     : color_by;
  const std::string& mapped = color.element.empty() ? color.column : color.carbon;
  if ((mapped.empty() && options.has_map) || (color.column.empty() && has_range))
    base::refuse(std::string(options.has_map ? "--map" : "--range") +
                 " has nothing to map: the colours are not those of a column; add --color-by COLUMN");
  const bool is_chosen = !mapped.empty() && !options.has_map;
  if (is_chosen)
    color.map = is_type || !color.carbon.empty() || (is_group(mapped, info.roles) && !has_range) ||
                        points::type_of(info, mapped) == data::ColumnType::kText
                    ? kCategoricalMap
                    : kMap;
  const auto map = points::find_color_map(color.map);
  if (has_range && map && map->is_categorical)
    base::refuse(fmt::format("--range has no effect: the map {} has a colour for each value", color.map));
  return is_chosen;
}

std::vector<std::string> choose_appearance(const PlotOptions& options, const DataFrames& data,
                                           scene::PointsKeys& points) {
  return Appearance(options, data, points).run();
}

}  // namespace orrery::plot
