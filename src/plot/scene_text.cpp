// SPDX-License-Identifier: Apache-2.0
#include "plot/scene_text.h"

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
    text_ += (text_.empty() ? "" : ", ") + key + " = " + value;
  }
  bool is_empty() const { return text_.empty(); }
  std::string text() const { return "{ " + text_ + " }"; }

 private:
  std::string text_;
};

std::string radius_text(const scene::PointsRadius& radius) {
  if (radius.value) return "radius = " + number_text(*radius.value) + "\n";
  InlineTable table, types;
  if (!radius.column.empty()) table.add("column", string_text(radius.column));
  if (!radius.element.empty()) table.add("element", string_text(radius.element));
  for (const auto& [type, value] : radius.types) types.add(string_text(type), number_text(value));
  if (!types.is_empty()) table.add("type", types.text());
  if (radius.scale != 1) table.add("scale", number_text(radius.scale));
  return table.is_empty() ? "" : "radius = " + table.text() + "\n";
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
  return table.is_empty() ? "" : "color = " + table.text() + "\n";
}

std::string points_text(const scene::Points& points) {
  std::string out =
      "[[points]]\nfile = " + string_text(points.file.string()) + "\nmaterial = \"matte\"\nmaterial_column = \"\"\n";
  if (points.frame) out += "frame = " + std::to_string(*points.frame) + "\n";
  if (points.component) out += "component = " + std::to_string(*points.component) + "\n";
  out += radius_text(points.radius) + color_text(points.color);
  if (!points.select.empty()) out += "select = " + string_text(points.select) + "\n";
  if (!(points.replicate == math::Vec3d{1, 1, 1})) out += "replicate = " + vector_text(points.replicate) + "\n";
  if (points.unwrap) out += "unwrap = true\n";
  if (!points.assembly.empty()) out += "assembly = " + string_text(points.assembly) + "\n";
  InlineTable clip;
  for (std::size_t axis = 0; axis < points.clip.size(); ++axis)
    if (points.clip[axis]) clip.add(std::string(1, "xyz"[axis]), scene::interval_text(*points.clip[axis]));
  if (!clip.is_empty()) out += "clip = " + clip.text() + "\n";
  if (points.skip_bad) out += "skip_bad = true\n";
  return out;
}

/// A lamp in front of the scene, to the upper left. It is behind the camera's plane, which does not see it.
std::string lamp_text(const PlotParts& parts) {
  const math::Vec3d back = math::normalized(parts.camera.look_from - parts.camera.look_at);
  const math::Vec3d right = math::cross(parts.camera.up, back);
  const math::Vec3d toward = math::normalized(back + parts.camera.up * 0.9 - right * 0.7);
  constexpr double kDistance = 6, kRadius = 1.2;  // in radii of the scene
  return "\n[[sphere]]\ncenter = " + vector_text(parts.center + toward * (kDistance * parts.radius)) +
         "\nradius = " + number_text(kRadius * parts.radius) + "\nmaterial = \"lamp\"\n";
}

std::string ground_text(const Ground& ground) {
  return "\n[[sphere]]\nname = \"ground\"\ncenter = " + vector_text(ground.center) +
         "\nradius = " + number_text(ground.radius) + "\nmaterial = \"ground\"\n";
}

}  // namespace

std::string scene_text(const PlotParts& parts) {
  const PlotOptions& options = parts.options;
  const bool is_night = options.style == Style::kNight;
  std::string out =
      "# Written by orrery plot for " + string_text(options.file.filename().string()) +
      "\n\n[image]\nwidth = " + std::to_string(options.width) + "\nheight = " + std::to_string(options.height) +
      "\n\n[camera]\nprojection = \"orthographic\"\nwidth = " + number_text(parts.camera.width.value_or(1)) +
      "\nlook_from = " + vector_text(parts.camera.look_from) + "\nlook_at = " + vector_text(parts.camera.look_at) +
      "\nup = " + vector_text(parts.camera.up) + "\n";
  out += std::string("\n[background]\ntype = \"constant\"\ncolor = ") +
         (is_night ? "[0.02, 0.02, 0.025]" : "[1, 1, 1]") + "\n";
  if (options.style == Style::kFlat) out += "\n[render]\nshading = \"flat\"\n";
  out += "\n[color]\nview = " + string_text(parts.view) +
         "\n\n[material.matte]\ntype = \"lambertian\"\nalbedo = [0.8, 0.8, 0.8]\n";
  if (parts.ground)
    out += std::string("\n[material.ground]\ntype = \"lambertian\"\nalbedo = ") +
           (is_night ? "[0.1, 0.1, 0.1]" : "[0.95, 0.95, 0.95]") + "\n";
  // Its irradiance at the centre, pi times radiance times (radius / distance)^2, is that of a white dome.
  if (is_night) out += "\n[material.lamp]\ntype = \"emitter\"\nradiance = [25, 24.5, 23.5]\n";
  out += "\n" + points_text(parts.points);
  if (parts.ground) out += ground_text(*parts.ground);
  if (is_night) out += lamp_text(parts);
  return out;
}

}  // namespace orrery::plot
