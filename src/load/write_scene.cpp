// SPDX-License-Identifier: Apache-2.0
#include "load/write_scene.h"

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/hash.h"
#include "data/write_table.h"
#include "scene/animation.h"
#include "scene/schema.h"
#include "scene/texture.h"

namespace orrery::load {
namespace {

using scene::number_text;
using scene::string_text;
using scene::vector_text;

constexpr const char* kMark = "# Written by orrery, which replaces it only if unchanged: checksum ";

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

/// The keys of a table that differ from their defaults, as in a scene file.
using KeyTexts = std::vector<std::pair<std::string, std::string>>;

std::string inline_table(const KeyTexts& keys) {
  std::string out;
  for (const auto& [name, text] : keys) out += fmt::format("{}{} = {}", out.empty() ? "" : ", ", name, text);
  return fmt::format("{{ {} }}", out);
}

/// Puts keys with dotted names into inline tables: `radius.column` becomes `radius = { column = ... }`. A key that has
/// a value itself excludes those in its table, as `radius` does.
KeyTexts nested(const KeyTexts& keys) {
  KeyTexts out;
  std::set<std::string> done;
  for (const auto& [name, text] : keys) {
    const std::string table = name.substr(0, name.find('.'));
    if (!done.insert(table).second) continue;
    if (table == name) {
      out.emplace_back(name, text);
      continue;
    }
    KeyTexts inner;
    for (const auto& [other, value] : keys)
      if (other.starts_with(table + ".")) inner.emplace_back(other.substr(table.size() + 1), value);
    out.emplace_back(table, inline_table(inner));
  }
  return out;
}

template <class Target>
KeyTexts texts_of(const std::vector<scene::Key<Target>>& keys, const Target& target, const Target& defaults) {
  KeyTexts out;
  for (const auto& key : keys)
    if (const std::string text = key.text(target); key.required || text != key.text(defaults))
      out.emplace_back(key.name, text);
  return out;
}

void add_table(std::string& out, const std::string& header, const KeyTexts& keys) {
  if (keys.empty()) return;
  out += header + '\n';
  for (const auto& [name, text] : nested(keys)) out += fmt::format("{} = {}\n", name, text);
  out += '\n';
}

/// Returns a texture as an inline table.
std::string texture_text(const scene::Texture& texture, scene::TextureUse use) {
  const scene::TextureTypeKeys& type = scene::type_of(texture, use);
  KeyTexts keys = texts_of(type.keys, texture, {});
  keys.emplace(keys.begin(), "texture", string_text(type.name));
  return inline_table(keys);
}

std::string material_text(const scene::MaterialModel& model) {
  const scene::MaterialType& type = scene::type_of(model);
  KeyTexts keys = texts_of(type.keys, model, type.model);
  for (const scene::TexturedKey& textured : type.textured)
    if (const scene::TextureSlot texture = textured.get(model)) {
      std::erase_if(keys, [&](const auto& key) { return key.first == textured.name; });
      keys.emplace_back(textured.name, texture_text(*texture, textured.use));
    }
  keys.emplace(keys.begin(), "type", string_text(type.name));
  return inline_table(keys);
}

/// Writes one line per material: a scene may have as many materials as spheres.
void add_materials(std::string& out, const std::vector<scene::Material>& materials) {
  if (materials.empty()) return;
  out += "[material]\n";
  std::set<std::string> names;
  for (const scene::Material& material : materials) {
    if (!names.insert(material.name).second)
      throw base::Error(base::ErrorKind::kInternal, "cannot write a scene with two materials named " + material.name);
    out += fmt::format("{} = {}\n", scene::key_text(material.name), material_text(material.model));
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
    out += fmt::format("[[key]]\ntarget = {}\n", string_text(track.target));
    for (const scene::Key<scene::Track>& key : scene::track_keys())
      out += fmt::format("{} = {}\n", key.name, key.text(track));
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

/// The header up to the comment that names the writer, as in data::write_table.
std::string ply_header_begin(std::string_view writer) {
  return fmt::format("ply\nformat binary_little_endian 1.0\ncomment made by {}\n", writer);
}

}  // namespace

std::string scene_text(const scene::Scene& scene, const std::string& comment) {
  std::string out;
  add_comment(out, comment);
  const scene::Scene defaults;
  for (const scene::Table& table : scene::tables())
    add_table(out, fmt::format("[{}]", table.name), texts_of(table.keys, scene, defaults));
  add_materials(out, scene.materials);
  const auto name_text = [&](std::uint32_t material) { return string_text(material_name(scene, material)); };
  const auto add = [&](const char* header, KeyTexts keys, std::uint32_t from, std::uint32_t to) {
    keys.emplace_back("material",
                      from == to ? name_text(from) : fmt::format("[{}, {}]", name_text(from), name_text(to)));
    add_table(out, header, keys);
  };
  for (const scene::Sphere& sphere : scene.spheres)
    add("[[sphere]]", texts_of(scene::sphere_keys(), sphere, {}), sphere.material, sphere.material);
  for (const scene::Rod& rod : scene.rods)
    add("[[rod]]", texts_of(scene::rod_keys(), rod, {}), rod.materials[0], rod.materials[1]);
  add_tracks(out, scene);
  for (const scene::PointsKeys& points : scene.points) {
    KeyTexts keys = texts_of(scene::points_keys(), points, {});
    if (points.bonds.material) keys.emplace_back("bonds.material", name_text(*points.bonds.material));
    add("[[points]]", keys, points.material, points.material);
  }
  for (const scene::RodFile& rods : scene.rod_files)
    add("[[rods]]", texts_of(scene::rod_file_keys(), rods, {}), rods.materials[0], rods.materials[1]);
  if (!out.empty()) out.pop_back();  // the blank line after the last block
  return out;
}

std::string marked_text(const std::string& text) { return fmt::format("{}{}\n{}", kMark, base::text_hash(text), text); }

void check_unedited(const std::filesystem::path& file) {
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) return;
  std::ifstream in(file, std::ios::binary);
  std::string mark;
  std::getline(in, mark);
  const bool is_ours = mark.starts_with(kMark);
  const std::string text = is_ours ? std::string(std::istreambuf_iterator<char>(in), {}) : "";
  if (is_ours && fmt::format("{}\n{}", mark, text) == marked_text(text)) return;
  throw base::Error(base::ErrorKind::kCannotCreate,
                    fmt::format("cannot create {}: the existing file was {}; choose another name, or replace it with "
                                "--force",
                                file.string(), is_ours ? "edited since orrery wrote it" : "not written by orrery"));
}

void write_ply(const scene::Points& points, const std::filesystem::path& file) {
  data::Table table;
  table.rows = points.centers.size();
  const auto add = [&](const char* name, auto value) {
    std::vector<decltype(value(std::size_t{0}))> values;
    values.reserve(table.rows);
    for (std::size_t i = 0; i < table.rows; ++i) values.push_back(value(i));
    table.columns.push_back({name, std::move(values)});
  };
  add("x", [&](std::size_t i) { return points.centers[i].x; });
  add("y", [&](std::size_t i) { return points.centers[i].y; });
  add("z", [&](std::size_t i) { return points.centers[i].z; });
  add("radius", [&](std::size_t i) { return points.radii[i]; });
  if (!points.materials.empty())
    add("material", [&](std::size_t i) { return static_cast<std::int64_t>(points.materials[i]); });
  static_cast<void>(data::write_table(file, table, {}, kPlyWriter));  // PLY stores all of these columns
}

bool is_ply_of(std::string_view writer, const std::filesystem::path& file) {
  const std::string begin = ply_header_begin(writer);
  std::string found(begin.size(), '\0');
  std::ifstream in(file, std::ios::binary);
  return in.read(found.data(), static_cast<std::streamsize>(found.size())) && found == begin;
}

void write_scene(const scene::Scene& scene, const std::string& comment, const std::filesystem::path& file) {
  for (const scene::Points& points : scene.points) write_ply(points, file.parent_path() / points.file);
  base::write_text_file(file, marked_text(scene_text(scene, comment)));
}

}  // namespace orrery::load
