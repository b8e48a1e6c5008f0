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

/// A lamp in front of the scene, to the upper left. It is behind the camera's plane, which does not see it.
std::string lamp_text(const PlotParts& parts) {
  const math::Vec3d back = math::normalized(parts.camera.look_from - parts.camera.look_at);
  const math::Vec3d right = math::cross(parts.camera.up, back);
  const math::Vec3d toward = math::normalized(back + parts.camera.up * 0.9 - right * 0.7);
  constexpr double kDistance = 6, kRadius = 1.2;  // in radii of the scene
  return fmt::format("\n[[sphere]]\ncenter = {}\nradius = {}\nmaterial = \"lamp\"\n",
                     vector_text(parts.center + toward * (kDistance * parts.radius)),
                     number_text(kRadius * parts.radius));
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
  const bool is_night = options.style == Style::kNight;
  std::string out = fmt::format(
      "# Written by orrery plot for {}\n"
      "\n"
      "[image]\n"
      "width = {}\n"
      "height = {}\n"
      "\n"
      "[camera]\n"
      "projection = \"orthographic\"\n"
      "width = {}\n"
      "look_from = {}\n"
      "look_at = {}\n"
      "up = {}\n",
      string_text(options.file.filename().string()), options.width, options.height,
      number_text(parts.camera.width.value_or(1)), vector_text(parts.camera.look_from),
      vector_text(parts.camera.look_at), vector_text(parts.camera.up));
  out +=
      fmt::format("\n[background]\ntype = \"constant\"\ncolor = {}\n", is_night ? "[0.02, 0.02, 0.025]" : "[1, 1, 1]");
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
  if (parts.ground)
    out += fmt::format("\n[material.ground]\ntype = \"lambertian\"\nalbedo = {}\n",
                       is_night ? "[0.1, 0.1, 0.1]" : "[0.95, 0.95, 0.95]");
  // Its irradiance at the centre, pi times radiance times (radius / distance)^2, is that of a white dome.
  if (is_night) out += "\n[material.lamp]\ntype = \"emitter\"\nradiance = [25, 24.5, 23.5]\n";
  out += "\n" + points_text(parts.points);
  if (parts.ground) out += ground_text(*parts.ground);
  if (is_night) out += lamp_text(parts);
  return out;
}

}  // namespace orrery::plot
