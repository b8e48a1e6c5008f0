// SPDX-License-Identifier: Apache-2.0
#include "format/write_tree.h"

#include <algorithm>

#include <fmt/core.h>

#include "format/toml_tree.h"

namespace orrery::format {
namespace {

bool is_list_of_tables(const toml::node& node) {
  const toml::array* array = node.as_array();
  return array != nullptr && !array->empty() && array->is_array_of_tables();
}

void write_table(const toml::table& table, const std::string& name, std::string& out) {
  const std::vector<Entry> entries = in_order(table);
  std::string body;
  for (const Entry& e : entries)
    if (!e.value->is_table() && !is_list_of_tables(*e.value))
      body += fmt::format("{} = {}\n", toml_text(*e.key), toml_text(*e.value));
  const bool has_tables =
      std::any_of(entries.begin(), entries.end(), [](const Entry& e) { return e.value->is_table(); });
  if (!name.empty() && (!body.empty() || !has_tables)) out += fmt::format("[{}]\n", name);
  if (!body.empty() || !name.empty()) out += body + (body.empty() && has_tables ? "" : "\n");
  const std::string prefix = name.empty() ? "" : name + ".";
  for (const Entry& e : entries)
    if (const toml::table* inner = e.value->as_table()) write_table(*inner, prefix + toml_text(*e.key), out);
  for (const Entry& e : entries) {
    if (!is_list_of_tables(*e.value)) continue;
    for (const toml::node& element : *e.value->as_array()) {
      out += fmt::format("[[{}{}]]\n", prefix, toml_text(*e.key));
      for (const Entry& inner : in_order(*element.as_table()))
        out += fmt::format("{} = {}\n", toml_text(*inner.key), toml_text(*inner.value));
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

std::string merged_text(const std::filesystem::path& name, const std::string& text, const Overrides& overrides,
                        const Renamed& renamed) {
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
