// SPDX-License-Identifier: Apache-2.0
#include "scene/schema.h"

#include <gtest/gtest.h>

#include <fmt/core.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "base/text.h"
#include "scene/texture.h"
#include "support/temp_dir.h"

namespace orrery::scene {
namespace reference {

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

/// Returns the "Keys" section of docs/scene-format.md: tables of all keys with type, range, unit, default and cost.
std::string markdown() {
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
  for (const auto& key : points_keys()) out += row(key, PointsKeys{});
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

}  // namespace reference

namespace {

constexpr const char* kBegin = "<!-- generated from the schema: begin -->\n";
constexpr const char* kEnd = "<!-- generated from the schema: end -->\n";

std::filesystem::path document() { return std::filesystem::path(ORRERY_ROOT) / "docs" / "scene-format.md"; }

// With ORRERY_UPDATE_DOCS in the environment, the test updates the document instead.
TEST(SceneReference, DocumentMatchesTheSchema) {
  const std::string text = support::file_bytes(document());
  const std::size_t begin = text.find(kBegin), end = text.find(kEnd);
  ASSERT_TRUE(begin != std::string::npos && end != std::string::npos) << document() << " has lost its markers";
  const std::size_t body = begin + std::string(kBegin).size();
  const std::string wanted = "\n" + reference::markdown() + "\n";
  if (std::getenv("ORRERY_UPDATE_DOCS") != nullptr) {
    support::write_bytes(document(), text.substr(0, body) + wanted + text.substr(end));
    return;
  }
  EXPECT_EQ(text.substr(body, end - body), wanted)
      << "run this test with ORRERY_UPDATE_DOCS=1 in the environment, and read what it changed";
}

TEST(SceneReference, RowsHaveRangeUnitDefaultAndCost) {
  const std::string text = reference::markdown();
  EXPECT_NE(text.find("| `vfov` | number | above 0 and below 180 | degrees | 90 |"), std::string::npos) << text;
  EXPECT_NE(text.find("| `samples` | integer | 1..2147483647 | per pixel | 100 | Paths per pixel | Time scales"),
            std::string::npos);
  EXPECT_NE(text.find("| `fresnel` | one of | `schlick, exact, none` | - | \"schlick\" |"), std::string::npos);
  EXPECT_NE(text.find("| `albedo` | [r, g, b] | each 0..1 | scene-linear | **required** |"), std::string::npos);
}

}  // namespace
}  // namespace orrery::scene
