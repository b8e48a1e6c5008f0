// SPDX-License-Identifier: Apache-2.0
#include "load/toml_tree.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <sstream>
#include <tuple>

#include <fmt/core.h>

#include "base/text.h"
#include "scene/schema.h"
#include "scene/texture.h"

namespace orrery::load {
namespace {

Place place_of_region(const toml::source_region& region) {
  Place place;
  if (region.path) place.text_name = *region.path;
  place.line = static_cast<int>(region.begin.line);
  place.column = static_cast<int>(region.begin.column);
  if (region.end.line == region.begin.line && region.end.column > region.begin.column)
    place.width = static_cast<int>(region.end.column - region.begin.column);
  return place;
}

using Fault = Override::Fault;

/// Returns the table that an override changes.
toml::table& target_of(toml::table& root, const std::string& element) {
  if (element.empty()) return root;
  if (toml::table* const table = toml::at_path(root, element).as_table()) return *table;
  const std::string name = element.substr(0, element.find('['));
  const toml::array* const list = root[name].as_array();
  if (list == nullptr) throw Fault{fmt::format("the scene has no list `{}`", name), kOverrideExample};
  throw Fault{
      fmt::format("{} does not exist; the scene has {} `{}` tables, counted from 0", element, list->size(), name), ""};
}

/// Moves `from` into `to`, merging tables.
///
/// `replaces`  inline tables replace what is there
void merge(toml::table& to, toml::table& from, bool replaces) {
  for (auto&& [key, node] : from) {
    toml::table* const inner = node.as_table();
    toml::node* const there = to.get(key.str());
    if (inner != nullptr && there != nullptr && !(replaces && inner->is_inline())) {
      if (toml::table* const table = there->as_table()) {
        merge(*table, *inner, replaces);
        continue;
      }
      if (there->is_array_of_tables())
        throw Fault{fmt::format("`{}` is not a table", key.str()), "name one of its elements, e.g. sphere[0].radius=2"};
    }
    node.visit([&to, &name = key](auto& value) { to.insert_or_assign(name, std::move(value)); });
  }
}

/// Applies one override. Its locations are in `line` of kOverrideName.
void apply_override(toml::table& root, const Override& override, int line) {
  if (override.fault) throw Fault(*override.fault);
  toml::table& target = target_of(root, override.element);
  const std::string above(static_cast<std::size_t>(line) - 1, '\n');
  toml::table tree = toml::parse(std::string_view(above + override.toml), std::string_view(kOverrideName));
  merge(target, tree, override.replaces);
}

void apply_overrides(toml::table& root, const Overrides& overrides, ReadState& state) {
  int line = 0;
  for (const Override& override : overrides) {
    ++line;
    try {
      apply_override(root, override, line);
    } catch (const Fault& fault) {
      state.error({kOverrideName, line, 1, 1}, fault.text, fault.remedy);
    }
  }
}

/// Removes the keys of the file that only other types have, if an override has replaced the type.
template <class Types>
void drop_keys_of_old_type(toml::table& table, const char* type_key, const Types& types) {
  const auto is_override = [](const toml::node& node) { return place_of(node).text_name == kOverrideName; };
  const toml::node* const node = table.get(type_key);
  if (node == nullptr || !is_override(*node)) return;
  const auto has = [](const auto& type, const std::string& name) {
    return std::any_of(type.keys.begin(), type.keys.end(), [&](const auto& key) { return key.name == name; });
  };
  const auto type = std::find_if(types.begin(), types.end(),
                                 [&](const auto& one) { return one.name == node->value_or(std::string()); });
  if (type == types.end()) return;
  std::vector<std::string> old;
  for (const auto& [key, value] : table)
    if (const std::string name(key.str());
        !is_override(value) && !has(*type, name) &&
        std::any_of(types.begin(), types.end(), [&](const auto& other) { return has(other, name); }))
      old.push_back(name);
  for (const std::string& name : old) table.erase(name);
}

/// Removes the keys of a material or texture that only its type in the file has, if an override has replaced the type.
void drop_keys_of_old_types(toml::table& root) {
  toml::table* const materials = root["material"].as_table();
  if (materials == nullptr) return;
  for (auto&& [name, node] : *materials) {
    toml::table* const material = node.as_table();
    if (material == nullptr) continue;
    drop_keys_of_old_type(*material, "type", scene::material_types());
    for (const scene::MaterialType& type : scene::material_types())
      if ((*material)["type"].value_or(std::string()) == type.name)
        for (const scene::TexturedKey& key : type.textured)
          if (toml::table* const texture = (*material)[key.name].as_table())
            drop_keys_of_old_type(*texture, "texture", scene::texture_types(key.use));
  }
}

}  // namespace

Place place_of(const toml::node& node) { return place_of_region(node.source()); }
Place place_of(const toml::key& key) { return place_of_region(key.source()); }

std::vector<Entry> in_order(const toml::table& table) {
  std::vector<Entry> out;
  for (const auto& [key, value] : table) {
    const Place place = place_of(key);
    out.push_back({&key, &value, place.text_name == kOverrideName, place.line, place.column});
  }
  std::stable_sort(out.begin(), out.end(), [](const Entry& a, const Entry& b) {
    return std::tie(a.is_override, a.line, a.column) < std::tie(b.is_override, b.line, b.column);
  });
  return out;
}

std::string toml_text(const toml::key& key) { return scene::key_text(std::string(key.str())); }

std::string toml_text(const toml::node& node) {
  std::string out;
  if (const toml::table* table = node.as_table()) {
    for (const Entry& e : in_order(*table))
      out += fmt::format("{}{} = {}", out.empty() ? "" : ", ", toml_text(*e.key), toml_text(*e.value));
    return out.empty() ? "{}" : fmt::format("{{ {} }}", out);
  }
  if (const toml::array* array = node.as_array()) {
    for (const toml::node& element : *array) out += (out.empty() ? "" : ", ") + toml_text(element);
    return fmt::format("[{}]", out);
  }
  if (const auto text = node.value_exact<std::string>()) return scene::string_text(*text);
  if (const auto number = node.value_exact<double>()) return scene::number_text(*number);
  if (const auto number = node.value_exact<std::int64_t>()) return std::to_string(*number);
  if (const auto truth = node.value_exact<bool>()) return *truth ? "true" : "false";
  std::ostringstream other;  // dates and times, which no key accepts
  node.visit([&](const auto& value) {
    if constexpr (toml::is_value<decltype(value)>) other << value;
  });
  return other.str();
}

Override::Fault fault_of(const toml::parse_error& error) {
  Override::Fault out{std::string(error.description()), {}};
  constexpr std::string_view kPreface = "Error while parsing ";
  if (out.text.starts_with(kPreface)) out.text.erase(0, kPreface.size());
  if (const std::size_t at = out.text.find("cannot redefine existing"); at != std::string::npos) {
    out.text = "duplicate: " + out.text.substr(at);
    out.remedy = "remove one of them";
  }
  return out;
}

Place too_deep_key(std::string_view text) {
  int parts = 1;
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (std::string_view("=,[]{}\n").find(text[at]) != std::string_view::npos) parts = 1;  // delimits keys
    if (text[at] != '.' || ++parts <= kDeepestKey) continue;
    const std::string_view before = text.substr(0, at), line = before.substr(before.rfind('\n') + 1);
    const auto lines = std::count(before.begin(), before.end(), '\n');
    const auto characters =
        std::count_if(line.begin(), line.end(), [](char c) { return !base::continues_character(c); });
    return {"", static_cast<int>(lines) + 1, static_cast<int>(characters) + 1, 1};
  }
  return {};
}

toml::table parse_tree(const std::string& file_name, const std::string& text, const Overrides& overrides,
                       ReadState& state) {
  state.source.set_file(file_name, text);
  state.source.set_overrides(overrides);
  if (Place place = too_deep_key(text); place.line > 0) {
    place.text_name = file_name;
    state.error(place, fmt::format("the key has more than {} parts", kDeepestKey));
    return {};
  }
  toml::table root;
  try {
    root = toml::parse(std::string_view(text), std::string_view(file_name));
  } catch (const toml::parse_error& error) {
    Place place = place_of_region(error.source());
    place.width = 1;
    const Fault fault = fault_of(error);
    state.error(place, fault.text, fault.remedy);
    return {};
  }
  apply_overrides(root, overrides, state);
  drop_keys_of_old_types(root);
  return root;
}

}  // namespace orrery::load
