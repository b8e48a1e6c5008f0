// SPDX-License-Identifier: Apache-2.0
#include "plot/scene_text.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "base/error.h"
#include "base/text.h"
#include "load/write_scene.h"
#include "math/vec3.h"
#include "plot/plot.h"
#include "plot/range.h"
#include "points/color_map.h"
#include "scene/limits.h"
#include "scene/value_text.h"

namespace orrery::plot {
namespace {

/// The light of a style: a spherical lamp to the upper left of the camera, a background, and what the camera sees of
/// it.
struct Lighting {
  Vec3d below, above;             ///< radiance of the background from straight below and above
  std::optional<Vec3d> backdrop;  ///< colour behind the spheres; none: the background
  std::optional<Vec3d> ground;    ///< albedo; none: that at which light on it, without shadows, is the backdrop
  // The lamp. It is behind the camera's plane, which does not see it.
  Vec3d radiance;   ///< 0: no lamp
  double up, left;  ///< its position along the image's axes, where the distance towards the camera is 1
  double distance;  ///< from the centre, in radii of the scene
  double radius;    ///< in radii of the scene

  bool has_lamp() const { return !(radiance == Vec3d{}); }
};

constexpr Vec3d grey(double value) { return {value, value, value}; }

/// Three fifths of the light on a sphere come from a lamp of 35 degrees, whose shadows are soft, 55 degrees from the
/// view axis, and the rest from all directions, more of it from above: gaps between spheres are dark, and large bodies
/// look round. The lamp is far away, so that it illuminates all parts alike. The mean radiance over the image of an
/// unoccluded matte sphere is then that of its albedo in white light of radiance 1, see lighting_of() (test
/// PlotPlot.TheMeanOfASphereIsItsColor).
constexpr Lighting kStudio{grey(0.12), grey(0.68), grey(1), {}, grey(14.934), 1.1, 0.9, 3000, 900};
/// The same mean, with more light from all directions and a lamp of 74 degrees: shadows are faint, and gaps dark.
constexpr Lighting kSoft{grey(0.7), grey(0.7), grey(1), {}, grey(2.3165), 0.9, 0.6, 3000, 1800};
constexpr Lighting kWhite{grey(1), grey(1), {}, {}, {}, 0, 0, 0, 0};
/// The irradiance at the centre, pi times radiance times (radius / distance)^2, is that of a white dome.
constexpr Lighting kNight{{0.02, 0.02, 0.025}, {0.02, 0.02, 0.025}, {}, grey(0.1), {25, 24.5, 23.5}, 0.9, 0.7, 6, 1.2};

const Lighting& lighting_of(Style style) {
  switch (style) {
    case Style::kStudio: return kStudio;
    case Style::kSoft:
    case Style::kIllustration: return kSoft;
    case Style::kNight: return kNight;
    case Style::kFlat:
    case Style::kAmbient: return kWhite;
  }
  return kWhite;
}

scene::Sphere lamp_of(const Stage& stage, const Lighting& light) {
  const Vec3d toward = math::normalized(stage.axes.back + stage.axes.up * light.up - stage.axes.right * light.left);
  return {stage.center + toward * (light.distance * stage.radius), light.radius * stage.radius};
}

/// The light of a plot.
Lighting lighting_of(const PlotOptions& options, const Stage& stage) {
  Lighting out = lighting_of(options.style.value_or(Style::kStudio));
  if (!(out.below == out.above)) {
    // The normals of the visible half of a sphere have a mean of two thirds towards the camera, and the light on a
    // surface has a mean of two thirds towards its normal. The lamp hides a part of the background.
    const Vec3d middle = (out.below + out.above) / 2, half = (out.above - out.below) / 2;
    const double factor = middle.x / (middle.x + half.x * 4 / 9 * math::dot(stage.axes.back, stage.up));
    out.below = out.below * factor;
    out.above = out.above * factor;
    const Vec3d to_lamp = math::normalized(lamp_of(stage, out).center - stage.center);
    out.radiance = out.radiance + (middle + half * math::dot(to_lamp, stage.up)) * factor;
  }
  for (Vec3d Lighting::*const of : {&Lighting::below, &Lighting::above, &Lighting::radiance})
    out.*of = out.*of * stage.gain;
  return out;
}

/// The albedo at which a ground without shadows has the colour of the backdrop, as far as one below 1 has.
Vec3d page_albedo(const Stage& stage, const Lighting& light, const Vec3d& backdrop) {
  // Of a Lambertian surface of albedo 1. The mean height of light is two thirds.
  Vec3d out = (light.below + light.above) / 2 + (light.above - light.below) / 3;
  if (light.has_lamp()) {
    const scene::Sphere lamp = lamp_of(stage, light);
    const double sine = light.radius / light.distance,
                 cosine = math::dot(math::normalized(lamp.center - stage.center), stage.up);
    out = out + light.radiance * (sine * sine * std::max(cosine, 0.0));
  }
  return {std::min(backdrop.x / out.x, 1.0), std::min(backdrop.y / out.y, 1.0), std::min(backdrop.z / out.z, 1.0)};
}

/// Rounds a number above 0 to two digits, so that what is within the result is within the number.
double rounded_down(double x) {
  const double unit = std::pow(10, std::floor(std::log10(x)) - 1);
  return std::floor(x / unit) * unit;
}

/// The lamp, the ground and the camera may be much farther from the origin than the data, whose user knows none of
/// them.
void require_room(const scene::Scene& scene, double reach, const std::filesystem::path& data) {
  double farthest = 0;
  const auto include = [&](const Vec3d& at, double length) {
    for (const double x : {at.x, at.y, at.z, length}) farthest = std::max(farthest, std::abs(x));
  };
  for (const scene::Sphere& sphere : scene.spheres) include(sphere.center, sphere.radius);
  include(scene.camera.look_from, scene.camera.width.value_or(0));
  if (farthest <= scene::kLargestLength) return;
  throw base::Error(
      base::ErrorKind::kBadData, "cannot use " + data.string(),
      {base::file_diagnostic(
          base::Severity::kError, data.string(),
          fmt::format("the spheres reach the coordinate {:.2g}, and the lamp, ground and camera around them {:.2g}; "
                      "the largest coordinate of a scene is {:g}",
                      reach, farthest, scene::kLargestLength),
          fmt::format("use a larger unit of length, in which the spheres are within {:.2g}",
                      rounded_down(scene::kLargestLength * (reach / farthest))))});
}

/// The enumerator with a name; none for an empty name.
template <class Enum>
std::optional<Enum> enumerator_of(const std::string& name, const std::vector<std::string>& names) {
  if (name.empty()) return {};
  return static_cast<Enum>(std::find(names.begin(), names.end(), name) - names.begin());
}

/// Materials of the rods of Guides, by their names.
constexpr std::pair<const char*, Vec3d> kGuideColors[] = {{"box", {0.1, 0.1, 0.1}},      {"axis_x", {0.7, 0.03, 0.03}},
                                                          {"axis_y", {0.03, 0.5, 0.03}}, {"axis_z", {0.03, 0.1, 0.8}},
                                                          {"axis_a", {0.7, 0.03, 0.03}}, {"axis_b", {0.03, 0.5, 0.03}},
                                                          {"axis_c", {0.03, 0.1, 0.8}}};

/// Radius of the edges of the box, and length and radius of the axes, as fractions of the radius of what is shown.
constexpr double kBoxRadius = 0.004, kAxisLength = 0.15, kAxisRadius = 0.01;
/// Distance of the origin of the axes of a unit cell from the cell, in lengths of an axis, which have letters.
constexpr double kBesideCell = 1.6;

}  // namespace

const std::vector<std::string>& style_names() {
  static const std::vector<std::string> names = {"studio", "soft", "flat", "night", "ambient", "illustration"};
  return names;
}

const std::vector<std::string>& quality_names() {
  static const std::vector<std::string> names = {"draft", "good", "final"};
  return names;
}

std::optional<Style> style_of(const std::string& name) { return enumerator_of<Style>(name, style_names()); }

std::optional<Quality> quality_of(const std::string& name) { return enumerator_of<Quality>(name, quality_names()); }

const std::vector<scene::Material>& sphere_materials() {
  static const std::vector<scene::Material> all = {{"matte", scene::Lambertian{{0.8, 0.8, 0.8}}},
                                                   {"plastic", scene::Plastic{{0.8, 0.8, 0.8}}},
                                                   {"metal", scene::Metal{{0.8, 0.8, 0.8}, 0.3}},
                                                   {"glass", scene::Dielectric{}}};
  return all;
}

const std::vector<std::string>& material_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> out;
    for (const scene::Material& material : sphere_materials()) out.push_back(material.name);
    return out;
  }();
  return names;
}

std::string scene_text(const PlotOptions& options, const Stage& stage, scene::Scene scene) {
  const Lighting light = lighting_of(options, stage);
  if (light.below == light.above) {
    scene.background.type = scene::BackgroundType::kConstant;
    scene.background.color = light.above;
  } else {
    scene.background.bottom = light.below;
    scene.background.top = light.above;
    scene.background.up = stage.up;
  }
  scene.background.backdrop = options.background ? options.background : light.backdrop;
  scene.background.alpha = options.transparent ? 0 : 1;
  if (options.style == Style::kFlat) scene.render.shading = scene::Shading::kFlat;
  const auto material = [&](const char* name, const scene::MaterialModel& model) {
    scene.materials.push_back({name, model});
    return static_cast<std::uint32_t>(scene.materials.size() - 1);
  };
  for (const scene::Material& of_spheres : sphere_materials())
    if (of_spheres.name == stage.material || !options.points.material_where.empty())
      material(of_spheres.name.c_str(), of_spheres.model);
  if (stage.ground) {
    const Vec3d albedo =
        light.ground.value_or(page_albedo(stage, light, scene.background.backdrop.value_or(light.above)));
    scene.spheres.push_back(
        {stage.ground->center, stage.ground->radius, material("ground", scene::Lambertian{albedo}), "ground"});
    scene.spheres.back().is_page = !light.ground;
  }
  for (const auto& [name, color] : kGuideColors) {
    const auto is_named = [&, &of_color = name](const scene::Rod& rod) { return rod.name == of_color; };
    if (std::none_of(scene.rods.begin(), scene.rods.end(), is_named)) continue;
    const std::uint32_t index = material(name, scene::Lambertian{color});
    for (scene::Rod& rod : scene.rods)
      if (is_named(rod)) rod.materials = {index, index};
  }
  if (light.has_lamp()) {
    scene.spheres.push_back(lamp_of(stage, light));
    scene.spheres.back().material = material("lamp", scene::Emitter{light.radiance});
  }
  require_room(scene, stage.reach, options.file);
  return load::scene_text(
      scene, fmt::format("Written by orrery plot for {}", scene::string_text(options.file.filename().string())));
}

void Guides::surround(const Vec3d& center, double radius) {
  corner_ = math::least(corner_, center - Vec3d{radius, radius, radius});
  for (const double x : {center.x, center.y, center.z}) reach_ = std::max(reach_, std::abs(x) + radius);
}

void Guides::surround(const scene::Points& points) {
  for (std::size_t i = 0; i < points.centers.size(); ++i) {
    const Vec3d center = points.centers[i];
    const double radius = std::abs(points.radii[i]);
    lowest_ = std::min(lowest_, math::dot(center, up_) - radius);
    surround(center, radius);
  }
}

void Guides::add(const Vec3d& from, const Vec3d& to, double radius, const char* name) {
  rods_.push_back({from, to, radius, {}, name});
  for (const Vec3d& end : {from, to}) {
    ends_.centers.push_back(end);
    ends_.radii.push_back(radius);
    lowest_ = std::min(lowest_, math::dot(end, up_) - radius);
  }
}

void Guides::add_box(const data::Box& box, const Vec3d& counts, ViewExtent& extent) {
  const Vec3d a = box.edges[0] * counts.x, b = box.edges[1] * counts.y, c = box.edges[2] * counts.z;
  const auto corner = [&](int i) { return box.origin + a * (i & 1) + b * (i >> 1 & 1) + c * (i >> 2 & 1); };
  for (int i = 0; i < 8; ++i) {
    extent.add(corner(i), 0);
    surround(corner(i), 0);
  }
  const double radius = rounded(kBoxRadius * extent.radius());
  for (int i = 0; i < 8; ++i)
    for (const int edge : {1, 2, 4})
      if ((i & edge) == 0) add(corner(i), corner(i | edge), radius, "box");
}

void Guides::add_axes(const ViewExtent& extent, const std::optional<data::Box>& cell) {
  const double length = rounded(kAxisLength * extent.radius()), radius = rounded(kAxisRadius * extent.radius());
  const Vec3d origin = cell ? extent.beside(kBesideCell * length) : corner_ - Vec3d{1, 1, 1} * (length + 2 * radius);
  constexpr const char *kNames[] = {"axis_x", "axis_y", "axis_z"}, *kCellNames[] = {"axis_a", "axis_b", "axis_c"};
  const data::Box axes = cell.value_or(data::Box{});
  for (std::size_t i = 0; i < 3; ++i)
    add(origin, origin + math::normalized(axes.edges[i]) * length, radius, (cell ? kCellNames : kNames)[i]);
}

}  // namespace orrery::plot
