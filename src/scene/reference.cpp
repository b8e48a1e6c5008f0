// SPDX-License-Identifier: Apache-2.0

#include <cstdint>

#include <fmt/core.h>

#include "base/text.h"
#include "scene/schema.h"
#include "scene/texture.h"

namespace orrery::scene {
namespace {

template <class Target>
bool is_color(const Key<Target>& key) {
  return key.type == ValueType::kVector && key.unit == "scene-linear";
}

template <class Target>
const char* type_name(const Key<Target>& key) {
  switch (key.type) {
    case ValueType::kInteger: return "integer";
    case ValueType::kNumber: return "number";
    case ValueType::kVector: return is_color(key) ? "[r, g, b]" : "[x, y, z]";
    case ValueType::kText: return "string";
    case ValueType::kChoice: return "one of";
    case ValueType::kChoices: return "list of";
    case ValueType::kWindow: return "[x, y, width, height]";
    case ValueType::kBoolean: return "boolean";
    case ValueType::kInterval: return "[low, high]";
    case ValueType::kName: return "string or integer";
    case ValueType::kTexts: return "list of strings";
    case ValueType::kNumbersByType: return "table of numbers";
    case ValueType::kColorsByType: return "table of [r, g, b]";
  }
  return "";
}

template <class Target>
std::string range_text(const Key<Target>& key) {
  switch (key.type) {
    case ValueType::kInteger:
      return fmt::format("{}..{}", static_cast<std::int64_t>(key.range.from), static_cast<std::int64_t>(key.range.to));
    case ValueType::kNumber:
    case ValueType::kNumbersByType: return key.range.text();
    case ValueType::kWindow: return "inside the image";
    case ValueType::kVector:
    case ValueType::kColorsByType: return "each " + key.range.text();
    case ValueType::kText:
    case ValueType::kTexts:
    case ValueType::kName: return "any";
    case ValueType::kInterval: return "low below high";
    case ValueType::kBoolean: return "`true`, `false`";
    case ValueType::kChoice:
    case ValueType::kChoices: return fmt::format("`{}`", base::joined(key.choices));
  }
  return "";
}

std::string header() {
  return "| key | type | range | unit | default | description | cost |\n|---|---|---|---|---|---|---|\n";
}

template <class Target>
std::string row(const Key<Target>& key, const Target& defaults) {
  const auto or_dash = [](const std::string& text) { return text.empty() ? std::string("-") : text; };
  std::string standard = key.required ? "**required**" : key.text(defaults);
  if (standard == "\"\"" || standard == "{}") standard = "none";
  std::string out = fmt::format("| `{}` | {} | {} | {}", key.name, type_name(key), range_text(key), or_dash(key.unit));
  return fmt::format("{} | {} | {} | {} |\n", out, standard, key.doc, or_dash(key.cost));
}

std::string material_row() {
  return "| `material` | string | name of a `[material.NAME]` | - | **required** | Material | - |\n";
}

std::string material_section() {
  std::string out = "### [material.NAME]\n\n| `type` | description |\n|---|---|\n";
  for (const MaterialType& type : material_types()) out += fmt::format("| `\"{}\"` | {} |\n", type.name, type.doc);
  for (const MaterialType& type : material_types()) {
    out += fmt::format("\nOther keys of `type = \"{}\"`:\n\n{}", type.name, header());
    for (const auto& key : type.keys) out += row(key, type.model);
  }
  return out;
}

const char* const kNumberNote =
    "For a number key, such as `fuzz`, the values `even`, `odd`, `low` and `high` are numbers. For `radiance`, their "
    "range "
    "is that of `radiance`.\n";

std::string texture_section() {
  std::string out = "### Textures\n\n| `texture` | description |\n|---|---|\n";
  for (const TextureTypeKeys& type : texture_types(TextureUse::kReflectance))
    out += fmt::format("| `\"{}\"` | {} |\n", type.name, type.doc);
  for (const TextureTypeKeys& type : texture_types(TextureUse::kReflectance)) {
    out += fmt::format("\nOther keys of `texture = \"{}\"`:\n\n{}", type.name, header());
    for (const auto& key : type.keys) out += row(key, Texture{});
  }
  return fmt::format("{}\n{}", out, kNumberNote);
}

}  // namespace

std::string reference_markdown() {
  std::string out;
  const Scene defaults;
  for (const Table& table : tables()) {
    out += fmt::format("### [{}]\n\n{}", table.name, header());
    for (const auto& key : table.keys) out += row(key, defaults);
    out += '\n';
  }
  out += fmt::format("{}\n{}\n### [[sphere]]\n\n{}", material_section(), texture_section(), header());
  for (const auto& key : sphere_keys()) out += row(key, Sphere{});
  out += fmt::format("{}\n### [[points]]\n\n{}", material_row(), header());
  for (const auto& key : points_keys()) out += row(key, Points{});
  out +=
      "| `bonds.material` | string | name of a `[material.NAME]`, not of type `dielectric` | - | as the spheres, half "
      "by "
      "half | Material of the bonds, without the colours of the spheres | - |\n";
  const std::string halves =
      "| `material` | string, or [string, string] | names of `[material.NAME]`, not of type `dielectric` | - | "
      "**required** | Material; or those of the half at `from` and of the half at `to` | - |\n";
  out += fmt::format("{}\n### [[rod]]\n\n{}", material_row(), header());
  for (const auto& key : rod_keys()) out += row(key, Rod{});
  out += fmt::format("{}\n### [[rods]]\n\n{}", halves, header());
  for (const auto& key : rod_file_keys()) out += row(key, RodFile{});
  return out + halves;
}

}  // namespace orrery::scene
