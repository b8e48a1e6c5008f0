// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/text.h"
#include "load/toml_tree.h"
#include "scene/schema.h"

namespace orrery::load {

/// Converts a node to the type of a key and checks its range or choices.
///
/// `name`     full name of the key, for messages
/// Result     nullopt on failure, which is reported
std::optional<scene::Value> read_value(ReadState& state, const toml::node& node, const std::string& name,
                                       scene::ValueType type, const scene::Range& range,
                                       const std::vector<std::string>& choices);

/// Reports the keys of a table and its subtables that are not known; `known` are dotted names.
void report_unknown_keys(ReadState& state, const toml::table& table, const std::string& table_name,
                         const std::vector<std::string>& known);

/// Reports an unknown key; `hint` replaces the suggestion.
void report_unknown_key(ReadState& state, const toml::key& key, const std::string& table_name,
                        const std::vector<std::string>& known, const std::string& hint = {});

/// Returns whether a key can be a table, because `known` contains dotted names that begin with it.
bool has_subkeys(const std::vector<std::string>& known, const std::string& name);

/// Reads a table into a target according to its keys. Keys in `also` are valid, but read by the caller.
template <class Target>
void read_keys(ReadState& state, const toml::table& table, const std::string& table_name,
               const std::vector<scene::Key<Target>>& keys, const std::vector<std::string>& also, Target& target) {
  std::vector<std::string> known = also;
  for (const auto& key : keys) known.push_back(key.name);
  report_unknown_keys(state, table, table_name, known);
  for (const auto& key : keys) {
    const toml::node* const node = toml::at_path(table, key.name).node();
    // `radius` may be a number or a table, whose keys are `radius.column` and so on.
    if (node != nullptr && node->is_table() && has_subkeys(known, key.name)) continue;
    const std::string full_name = table_name + "." + key.name;
    if (node == nullptr) {
      if (!key.required) continue;
      state.error(place_of(table), table_name + " needs `" + key.name + "`");
      state.unread.insert(full_name);
    } else if (const auto value = read_value(state, *node, full_name, key.type, key.range, key.choices)) {
      key.set(target, *value);
    } else {
      state.unread.insert(full_name);
    }
  }
}

/// Reads the [material.NAME] tables in the order of the file, which defines the material indices of points files.
/// Materials that only overrides define follow. An invalid material keeps its name and index, so that spheres that use
/// it cause no further errors.
void read_materials(ReadState& state, const toml::table& root, std::vector<scene::Material>& materials);

/// Reads the [[key]] tables into the tracks of a scene whose materials and spheres have been read.
void read_tracks(ReadState& state, const toml::array& list, scene::Scene& scene);

/// Reports the tracks whose values are out of range at a frame: cubic tracks may overshoot between their keys.
void check_tracks(ReadState& state, const toml::array& list, const scene::Scene& scene, double frame);

}  // namespace orrery::load
