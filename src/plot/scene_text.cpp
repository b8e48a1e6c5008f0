// SPDX-License-Identifier: Apache-2.0
#include "plot/scene_text.h"

#include <fmt/core.h>

#include "plot/plot.h"

#include "scene/schema.h"
#include "scene/value_text.h"

namespace orrery::plot {
namespace {

using scene::number_text;
using scene::string_text;
using scene::vector_text;

/// Collects `key = value` parts of an inline table.
class InlineTable {
 public:
  void add(const std::string& key, const std::string& value) {
    text_ += fmt::format("{}{} = {}", text_.empty() ? "" : ", ", key, value);
  }
  bool is_empty() const { return text_.empty(); }
  std::string text() const { return fmt::format("{{ {} }}", text_); }

 private:
  std::string text_;
};

std::string radius_text(const scene::PointsRadius& radius) {
  if (radius.value) return fmt::format("radius = {}\n", number_text(*radius.value));
  InlineTable table, types;
  if (!radius.column.empty()) table.add("column", string_text(radius.column));
  if (!radius.element.empty()) table.add("element", string_text(radius.element));
  for (const auto& [type, value] : radius.types) types.add(string_text(type), number_text(value));
  if (!types.is_empty()) table.add("type", types.text());
  if (radius.scale != 1) table.add("scale", number_text(radius.scale));
  return table.is_empty() ? "" : fmt::format("radius = {}\n", table.text());
}

std::string color_text(const scene::PointsColor& color) {
  InlineTable table;
  if (!color.column.empty()) {
    table.add("column", string_text(color.column));
    table.add("map", string_text(color.map));
    if (color.range) table.add("range", scene::interval_text(*color.range));
  }
  if (!color.element.empty()) table.add("element", string_text(color.element));
  if (color.rgb) table.add("rgb", "true");
  return table.is_empty() ? "" : fmt::format("color = {}\n", table.text());
}

std::string points_text(const scene::Points& points) {
  std::string out = fmt::format("[[points]]\nfile = {}\nmaterial = \"matte\"\nmaterial_column = \"\"\n",
                                string_text(points.file.string()));
  if (points.frame) out += fmt::format("frame = {}\n", *points.frame);
  if (points.component) out += fmt::format("component = {}\n", *points.component);
  out += radius_text(points.radius) + color_text(points.color);
  if (!points.select.empty()) out += fmt::format("select = {}\n", string_text(points.select));
  if (!(points.replicate == math::Vec3d{1, 1, 1}))
    out += fmt::format("replicate = {}\n", vector_text(points.replicate));
  if (points.unwrap) out += "unwrap = true\n";
  if (!points.assembly.empty()) out += fmt::format("assembly = {}\n", string_text(points.assembly));
  InlineTable clip;
  for (std::size_t axis = 0; axis < points.clip.size(); ++axis)
    if (points.clip[axis]) clip.add(std::string(1, "xyz"[axis]), scene::interval_text(*points.clip[axis]));
  if (!clip.is_empty()) out += fmt::format("clip = {}\n", clip.text());
  if (points.skip_bad) out += "skip_bad = true\n";
  return out;
}

/// The light of a style: a spherical lamp to the upper left of the camera, a background, and what the camera sees of
/// it.
struct Lighting {
  const char* background;  ///< radiance from all directions
  const char* backdrop;    ///< colour behind the spheres; null: the background
  const char* ground;      ///< albedo
  // The lamp. It is behind the camera's plane, which does not see it.
  const char* radiance;  ///< null: no lamp
  double up, left;       ///< its position along the image's axes, where the distance towards the camera is 1
  double distance;       ///< from the centre, in radii of the scene
  double radius;         ///< in radii of the scene
};

/// Half of the light on a sphere comes from all directions, so that gaps between spheres are dark, and half from a lamp
/// of 35 degrees, whose shadows are soft. It is far away, so that it illuminates all parts alike. The mean radiance
/// over the image of an unoccluded matte sphere is then that of its albedo in white light of radiance 1 (test
/// PlotPlot.TheMeanOfASphereInTheStudioIsItsColor).
constexpr Lighting kStudio = {
    "[0.5, 0.5, 0.5]", "[1, 1, 1]", "[0.75, 0.75, 0.75]", "[10.896, 10.896, 10.896]", 0.7, 0.5, 100, 30};
constexpr Lighting kWhite = {"[1, 1, 1]", nullptr, "[0.95, 0.95, 0.95]", nullptr, 0, 0, 0, 0};
/// The irradiance at the centre, pi times radiance times (radius / distance)^2, is that of a white dome.
constexpr Lighting kNight = {"[0.02, 0.02, 0.025]", nullptr, "[0.1, 0.1, 0.1]", "[25, 24.5, 23.5]", 0.9, 0.7, 6, 1.2};

const Lighting& lighting_of(Style style) {
  switch (style) {
    case Style::kStudio: return kStudio;
    case Style::kAmbient:
    case Style::kFlat: return kWhite;
    case Style::kNight: return kNight;
  }
  return kWhite;
}

std::string lamp_text(const PlotParts& parts, const Lighting& light) {
  const math::Vec3d toward =
      math::normalized(parts.axes.back + parts.axes.up * light.up - parts.axes.right * light.left);
  return fmt::format("\n[[sphere]]\ncenter = {}\nradius = {}\nmaterial = \"lamp\"\n",
                     vector_text(parts.center + toward * (light.distance * parts.radius)),
                     number_text(light.radius * parts.radius));
}

std::string camera_text(const PlotParts& parts) {
  const scene::Camera& camera = parts.camera;
  const bool is_perspective = camera.projection == scene::Projection::kPerspective;
  return fmt::format("[camera]\nprojection = \"{}\"\n{} = {}\nlook_from = {}\nlook_at = {}\nup = {}\n",
                     is_perspective ? "perspective" : "orthographic", is_perspective ? "vfov" : "width",
                     number_text(is_perspective ? camera.vfov : camera.width.value_or(1)),
                     vector_text(camera.look_from), vector_text(camera.look_at), vector_text(camera.up));
}

std::string ground_text(const Ground& ground) {
  return fmt::format(
      "\n"
      "[[sphere]]\n"
      "name = \"ground\"\n"
      "center = {}\n"
      "radius = {}\n"
      "material = \"ground\"\n",
      vector_text(ground.center), number_text(ground.radius));
}

}  // namespace

std::string scene_text(const PlotParts& parts) {
  const PlotOptions& options = parts.options;
  const Lighting& light = lighting_of(options.style.value_or(Style::kStudio));
  std::string out = fmt::format(
      "# Written by orrery plot for {}\n"
      "\n"
      "[image]\n"
      "width = {}\n"
      "height = {}\n"
      "\n"
      "{}"
      "\n"
      "[background]\n"
      "type = \"constant\"\n"
      "color = {}\n",
      string_text(options.file.filename().string()), parts.width, parts.height, camera_text(parts), light.background);
  if (light.backdrop != nullptr) out += fmt::format("backdrop = {}\n", light.backdrop);
  if (options.style == Style::kFlat) out += "\n[render]\nshading = \"flat\"\n";
  out += fmt::format(
      "\n"
      "[color]\n"
      "view = {}\n"
      "\n"
      "[material.matte]\n"
      "type = \"lambertian\"\n"
      "albedo = [0.8, 0.8, 0.8]\n",
      string_text(parts.view));
  if (parts.ground) out += fmt::format("\n[material.ground]\ntype = \"lambertian\"\nalbedo = {}\n", light.ground);
  if (light.radiance != nullptr)
    out += fmt::format("\n[material.lamp]\ntype = \"emitter\"\nradiance = {}\n", light.radiance);
  out += "\n" + points_text(parts.points);
  if (parts.ground) out += ground_text(*parts.ground);
  if (light.radiance != nullptr) out += lamp_text(parts, light);
  return out;
}

}  // namespace orrery::plot
