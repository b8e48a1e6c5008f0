// SPDX-License-Identifier: Apache-2.0
#include "format/write_tree.h"

#include <algorithm>
#include <cstdint>
#include <sstream>
#include <tuple>

#include <fmt/core.h>

#include "format/overrides.h"
#include "format/toml_tree.h"
#include "scene/value_text.h"

namespace orrery::format {
namespace {

/// A key with its value, and its place in the file or among the overrides.
struct Entry {
  const toml::key* key;
  const toml::node* value;
  bool is_override;
  int line, column;
};

/// The entries of a table in the order of the file; the library sorts them by name.
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

std::string key_text(const toml::key& key) {
  const std::string name(key.str());
  const bool is_bare = !name.empty() && std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
  return is_bare ? name : scene::string_text(name);
}

/// Writes a value on one line.
std::string value_text(const toml::node& node) {
  std::string out;
  if (const toml::table* table = node.as_table()) {
    for (const Entry& e : in_order(*table))
      out += fmt::format("{}{} = {}", out.empty() ? "" : ", ", key_text(*e.key), value_text(*e.value));
    return out.empty() ? "{}" : fmt::format("{{ {} }}", out);
  }
  if (const toml::array* array = node.as_array()) {
    for (const toml::node& element : *array) out += (out.empty() ? "" : ", ") + value_text(element);
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

bool is_list_of_tables(const toml::node& node) {
  const toml::array* array = node.as_array();
  return array != nullptr && !array->empty() && array->is_array_of_tables();
}

void write_table(const toml::table& table, const std::string& name, std::string& out) {
  const std::vector<Entry> entries = in_order(table);
  std::string body;
  for (const Entry& e : entries)
    if (!e.value->is_table() && !is_list_of_tables(*e.value))
      body += fmt::format("{} = {}\n", key_text(*e.key), value_text(*e.value));
  const bool has_tables =
      std::any_of(entries.begin(), entries.end(), [](const Entry& e) { return e.value->is_table(); });
  if (!name.empty() && (!body.empty() || !has_tables)) out += fmt::format("[{}]\n", name);
  if (!body.empty() || !name.empty()) out += body + (body.empty() && has_tables ? "" : "\n");
  const std::string prefix = name.empty() ? "" : name + ".";
  for (const Entry& e : entries)
    if (const toml::table* inner = e.value->as_table()) write_table(*inner, prefix + key_text(*e.key), out);
  for (const Entry& e : entries) {
    if (!is_list_of_tables(*e.value)) continue;
    for (const toml::node& element : *e.value->as_array()) {
      out += fmt::format("[[{}{}]]\n", prefix, key_text(*e.key));
      for (const Entry& inner : in_order(*element.as_table()))
        out += fmt::format("{} = {}\n", key_text(*inner.key), value_text(*inner.value));
      out += "\n";
    }
  }
}

using Renamed = std::function<std::string(const std::string& file)>;

void rename(toml::node_view<toml::node> file, const Renamed& renamed) {
  if (toml::value<std::string>* text = file.as_string(); text != nullptr && !text->get().empty())
    *text = renamed(text->get());
}

/// Renames the files that named_files() finds, and those of colour maps.
void rename_files(toml::table& root, const Renamed& renamed) {
  rename(root["color"]["config"], renamed);
  rename(root["background"]["file"], renamed);
  if (toml::table* const materials = root["material"].as_table())
    for (auto&& [name, node] : *materials)
      if (toml::table* const material = node.as_table())
        for (auto&& [key, value] : *material)
          if (toml::table* const texture = value.as_table()) rename((*texture)["file"], renamed);
  toml::array* const points = root["points"].as_array();
  for (std::size_t i = 0; points != nullptr && i < points->size(); ++i) {
    rename(root["points"][i]["file"], renamed);
    const auto map = root["points"][i]["color"]["map"];
    if (map.value_or(std::string()).find_first_of("./\\") != std::string::npos) rename(map, renamed);
  }
}

}  // namespace

std::string merged_text(const std::filesystem::path& name, const std::string& text,
                        const std::vector<Override>& overrides, const Renamed& renamed) {
  SourceText source;
  Diagnostics diagnostics;
  toml::table root = parse_tree(name.string(), text, overrides, source, diagnostics);
  diagnostics.raise_errors(name.string());
  rename_files(root, renamed);
  std::string out;
  write_table(root, "", out);
  if (out.ends_with("\n\n")) out.pop_back();
  return out;
}

}  // namespace orrery::format
