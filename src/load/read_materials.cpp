// SPDX-License-Identifier: Apache-2.0
#include "load/read_keys.h"

#include <algorithm>
#include <memory>
#include <string>

#include <fmt/core.h>

#include "base/text.h"
#include "scene/texture.h"

namespace orrery::load {
namespace {

/// Returns which material types have a key: "`fuzz` belongs to metal".
std::string other_type_with(const std::string& key) {
  std::vector<std::string> owners;
  for (const scene::MaterialType& type : scene::material_types())
    for (const auto& known : type.keys)
      if (known.name == key) owners.push_back(type.name);
  if (key == "opacity") return "glass is transparent already; use another type of material";
  return owners.empty() ? "" : fmt::format("`{}` belongs to {}", key, base::joined(owners));
}

/// Reads the type of a table whose keys depend on it, a material or a texture. If it is missing or unknown, reports
/// that and the keys that no type has, and returns null.
template <class Type>
const Type* read_type(ReadState& state, const toml::table& table, const std::string& full_name, const char* type_key,
                      const std::vector<Type>& types) {
  std::vector<std::string> names, keys = {type_key};
  for (const Type& type : types) {
    names.push_back(type.name);
    for (const auto& key : type.keys)
      if (!base::contains(keys, key.name)) keys.push_back(key.name);
  }
  const toml::node* node = table.get(type_key);
  const auto name = node == nullptr ? std::nullopt
                                    : read_value(state, *node, fmt::format("{}.{}", full_name, type_key),
                                                 scene::ValueType::kChoice, {}, names);
  if (node == nullptr)
    state.error(place_of(table), fmt::format("{} needs `{}`", full_name, type_key), "one of " + base::joined(names));
  if (!name) report_unknown_keys(state, table, full_name, keys);
  const auto named = [&](const Type& type) { return name && type.name == std::get<std::string>(*name); };
  const auto found = std::find_if(types.begin(), types.end(), named);
  return found == types.end() ? nullptr : &*found;
}

/// Reads a texture, the value of a material's key; null, and an error is reported, if its type is missing or unknown.
scene::TextureSlot read_texture(ReadState& state, const toml::table& table, const std::string& full_name,
                                const std::vector<scene::TextureTypeKeys>& types) {
  const scene::TextureTypeKeys* const type = read_type(state, table, full_name, "texture", types);
  if (type == nullptr) return nullptr;
  const auto texture = std::make_shared<scene::Texture>();
  texture->type = type->type;
  read_keys(state, table, full_name, type->keys, {"texture"}, *texture);
  return texture;
}

/// Reads the keys whose values are tables as textures. Their names are added to `also`.
void read_textures(ReadState& state, const toml::table& table, const std::string& full_name,
                   const scene::MaterialType& type, std::vector<std::string>& also, scene::MaterialModel& model) {
  for (const scene::TexturedKey& key : type.textured) {
    const toml::node* node = table.get(key.name);
    if (node == nullptr || !node->is_table()) continue;
    key.at(model) = read_texture(state, *node->as_table(), fmt::format("{}.{}", full_name, key.name),
                                 scene::texture_types(key.use));
    for (const auto& [word, value] : *node->as_table()) also.push_back(fmt::format("{}.{}", key.name, word.str()));
    also.push_back(key.name + ".texture");
  }
}

void read_material(ReadState& state, const toml::table& table, scene::Material& material) {
  const std::string full_name = "material." + material.name;
  const scene::MaterialType* type = read_type(state, table, full_name, "type", scene::material_types());
  if (type == nullptr) return;
  std::vector<std::string> known = {"type"};
  for (const auto& key : type->keys) known.push_back(key.name);
  std::vector<std::string> also = {"type"};  // and keys of other types, which are reported here with the types' names
  for (const auto& [key, node] : table) {
    const std::string word(key.str());
    if (base::contains(known, word) || other_type_with(word).empty()) continue;
    report_unknown_key(state, key, fmt::format("{} of type {}", full_name, type->name), known, other_type_with(word));
    also.push_back(word);
  }
  material.model = type->model;
  read_textures(state, table, full_name, *type, also, material.model);
  read_keys(state, table, full_name, type->keys, also, material.model);
}

}  // namespace

void read_materials(ReadState& state, const toml::table& root, std::vector<scene::Material>& materials) {
  const toml::node* node = root.get("material");
  if (node == nullptr) return;
  const toml::table* all = node->as_table();
  if (all == nullptr) {
    state.error(place_of(*node), "`material` must contain tables", "write [material.NAME]");
    return;
  }
  // The library sorts keys by name, but points files count materials in the order of the file. Materials added by
  // overrides come last, because they would otherwise change the indices.
  for (const Entry& entry : in_order(*all)) {
    const std::string name(entry.key->str());
    // An invalid material is added, too: spheres may use its name without further errors.
    materials.push_back({name, scene::Lambertian{}});
    if (const toml::table* table = entry.value->as_table()) {
      read_material(state, *table, materials.back());
    } else {
      state.error(place_of(*entry.value), fmt::format("material.{} must be a table", name),
                  fmt::format("write [material.{}]", name));
    }
  }
}

}  // namespace orrery::load
