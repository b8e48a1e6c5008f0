// SPDX-License-Identifier: Apache-2.0
#include "format/write_scene.h"

#include <algorithm>
#include <set>
#include <sstream>

#include <fmt/core.h>

#include "base/atomic_file.h"
#include "base/error.h"
#include "format/write_ply.h"
#include "format/written_text.h"
#include "scene/animation.h"
#include "scene/schema.h"
#include "scene/texture.h"
#include "scene/value_text.h"

namespace orrery::format {
namespace {

using scene::number_text;
using scene::string_text;
using scene::vector_text;

bool is_bare_key(const std::string& name) {
  return !name.empty() && name.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-") ==
                              std::string::npos;
}

void add_comment(std::string& out, const std::string& comment) {
  std::istringstream lines(comment);
  for (std::string line; std::getline(lines, line);) {
    // TOML comments must not contain control characters, which a file name in the comment may have.
    std::replace_if(
        line.begin(), line.end(), [](char c) { return (c >= 0 && c < ' ' && c != '\t') || c == 0x7f; }, '?');
    out += line.empty() ? "#\n" : fmt::format("# {}\n", line);
  }
  if (!comment.empty()) out += '\n';
}

void add_tables(std::string& out, const scene::Scene& scene) {
  const scene::Scene defaults;
  for (const scene::Table& table : scene::tables()) {
    std::string body;
    for (const auto& key : table.keys)
      if (key.text(scene) != key.text(defaults)) body += fmt::format("{} = {}\n", key.name, key.text(scene));
    if (!body.empty()) out += fmt::format("[{}]\n{}\n", table.name, body);
  }
}

/// Returns a texture as an inline table.
std::string texture_text(const scene::Texture& texture, scene::TextureUse use) {
  const scene::TextureTypeKeys& type = scene::texture_types(use)[static_cast<std::size_t>(texture.type)];
  std::string out = "{ texture = " + string_text(type.name);
  for (const auto& key : type.keys)
    if (key.required || key.text(texture) != key.text(scene::Texture{}))
      out += fmt::format(", {} = {}", key.name, key.text(texture));
  return out + " }";
}

/// Returns the value of a material's key: a texture or a constant; empty if it is the default.
std::string value_text(const scene::MaterialType& type, const scene::Key<scene::MaterialModel>& key,
                       const scene::MaterialModel& model) {
  for (const scene::TexturedKey& textured : type.textured)
    if (textured.name == key.name)
      if (const scene::TextureSlot texture = textured.get(model)) return texture_text(*texture, textured.use);
  const bool is_default = !key.required && key.text(model) == key.text(type.model);
  return is_default ? "" : key.text(model);
}

/// Writes one line per material: a scene may have as many materials as spheres.
void add_materials(std::string& out, const std::vector<scene::Material>& materials) {
  if (materials.empty()) return;
  out += "[material]\n";
  std::set<std::string> names;
  for (const scene::Material& material : materials) {
    if (!names.insert(material.name).second)
      throw base::Error(base::ErrorKind::kInternal, "cannot write a scene with two materials named " + material.name);
    const scene::MaterialType& type = scene::material_types()[material.model.index()];
    out += fmt::format("{} = {{ type = {}", is_bare_key(material.name) ? material.name : string_text(material.name),
                       string_text(type.name));
    for (const auto& key : type.keys)
      if (const std::string value = value_text(type, key, material.model); !value.empty())
        out += fmt::format(", {} = {}", key.name, value);
    out += " }\n";
  }
  out += '\n';
}

void add_tracks(std::string& out, const scene::Scene& scene) {
  const auto list = [&](const char* key, std::size_t size, auto text) {
    out += std::string(key) + " = [";
    for (std::size_t i = 0; i < size; ++i) out += (i > 0 ? ", " : "") + text(i);
    out += "]\n";
  };
  for (const scene::Track& track : scene.tracks) {
    const auto target = scene::find_animated(scene, track.target);
    const bool is_vector = target && target->type == scene::ValueType::kVector;
    out += fmt::format("[[key]]\ntarget = {}\ninterpolation = {}\n", string_text(track.target),
                       string_text(scene::interpolation_names()[static_cast<std::size_t>(track.interpolation)]));
    list("frames", track.frames.size(), [&](std::size_t i) { return number_text(track.frames[i]); });
    list("values", track.values.size(),
         [&](std::size_t i) { return is_vector ? vector_text(track.values[i]) : number_text(track.values[i].x); });
    out += '\n';
  }
}

const std::string& material_name(const scene::Scene& scene, std::uint32_t material) {
  if (material >= scene.materials.size())
    throw base::Error(base::ErrorKind::kInternal,
                      fmt::format("cannot write a scene that uses missing material {}", material));
  return scene.materials[material].name;
}

}  // namespace

std::string scene_text(const scene::Scene& scene, const std::string& comment) {
  std::string out;
  add_comment(out, comment);
  add_tables(out, scene);
  add_materials(out, scene.materials);
  for (const scene::Sphere& sphere : scene.spheres) {
    out += "[[sphere]]\n";
    if (!sphere.name.empty()) out += fmt::format("name = {}\n", string_text(sphere.name));
    if (!sphere.group.empty()) out += fmt::format("group = {}\n", string_text(sphere.group));
    out += fmt::format("center = {}\nradius = {}\nmaterial = {}\n\n", vector_text(sphere.center),
                       number_text(sphere.radius), string_text(material_name(scene, sphere.material)));
  }
  add_tracks(out, scene);
  for (const scene::Points& points : scene.points) {
    out += fmt::format("[[points]]\nfile = {}\nmaterial = {}\n", string_text(points.file.string()),
                       string_text(material_name(scene, points.material)));
    if (!points.name.empty()) out += fmt::format("name = {}\n", string_text(points.name));
    if (!points.group.empty()) out += fmt::format("group = {}\n", string_text(points.group));
    if (points.radius.value) out += fmt::format("radius = {}\n", number_text(*points.radius.value));
    out += '\n';
  }
  if (!out.empty()) out.pop_back();  // the blank line after the last block
  return out;
}

void write_scene(const scene::Scene& scene, const std::string& comment, const std::filesystem::path& file) {
  for (const scene::Points& points : scene.points) write_ply(points, file.parent_path() / points.file);
  base::write_text_file(file, marked_text(scene_text(scene, comment)));
}

}  // namespace orrery::format
