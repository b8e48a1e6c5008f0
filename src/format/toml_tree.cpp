// SPDX-License-Identifier: Apache-2.0
#include "format/toml_tree.h"

#include <cctype>
#include <cstdlib>
#include <variant>

namespace orrery::format {
namespace {

Place place_of(const toml::source_region& region) {
  Place place;
  if (region.path) place.text_name = *region.path;
  place.line = static_cast<int>(region.begin.line);
  place.column = static_cast<int>(region.begin.column);
  if (region.end.line == region.begin.line && region.end.column > region.begin.column)
    place.width = static_cast<int>(region.end.column - region.begin.column);
  return place;
}

base::Finding parse_finding(const toml::parse_error& error, const SourceText& source) {
  Place place = place_of(error.source());
  place.width = 1;
  return source.finding(base::Severity::kError, place, std::string(error.description()));
}

/// "sphere[2].radius" as {"sphere", 2, "radius"}; empty where it is not a path.
using Step = std::variant<std::string, std::size_t>;
std::vector<Step> parse_path(std::string_view path) {
  std::vector<Step> steps;
  std::size_t i = 0;
  while (i < path.size()) {
    if (path[i] == '[') {
      const std::size_t end = path.find(']', i);
      if (end == std::string_view::npos || end == i + 1 || end - i > 10) return {};
      for (std::size_t k = i + 1; k < end; ++k)
        if (std::isdigit(static_cast<unsigned char>(path[k])) == 0) return {};
      steps.emplace_back(static_cast<std::size_t>(std::strtoul(std::string(path.substr(i + 1, end - i - 1)).c_str(), nullptr, 10)));
      i = end + 1;
      if (i < path.size() && path[i] == '.') ++i;
      continue;
    }
    std::size_t end = path.find_first_of(".[", i);
    if (end == std::string_view::npos) end = path.size();
    if (end == i) return {};
    steps.emplace_back(std::string(path.substr(i, end - i)));
    i = end < path.size() && path[end] == '.' ? end + 1 : end;
  }
  return steps;
}

/// Puts a node where the path says, making tables on the way as a scene file's headers would.
///
/// Result     what is wrong with the path, empty where nothing is
std::string put(toml::table& root, const std::vector<Step>& steps, toml::node&& value) {
  toml::node* at = &root;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const bool last = i + 1 == steps.size();
    if (const auto* name = std::get_if<std::string>(&steps[i])) {
      toml::table* table = at->as_table();
      if (table == nullptr) return "`" + *name + "` is not inside a table";
      if (last) {
        std::move(value).visit([&](auto&& node) { table->insert_or_assign(*name, std::move(node)); });
        return {};
      }
      at = table->get(*name);
      if (at == nullptr) at = &table->insert_or_assign(*name, toml::table{}).first->second;
    } else {
      const std::size_t index = std::get<std::size_t>(steps[i]);
      toml::array* array = at->as_array();
      if (array == nullptr || index >= array->size())
        return "there is no [" + std::to_string(index) + "]; " +
               (array == nullptr ? "this is not a list" : "the list has " + std::to_string(array->size()) + ", counted from 0");
      if (last) return "an element of a list cannot be replaced as a whole; name one of its keys";
      at = array->get(index);
    }
  }
  return "it names nothing";
}

/// The value of an override with its place; spaces stand in for the key, so that columns are those of the override.
///
/// `line` is the override's number: all of them together are one text, a line each.
toml::table parse_value(const std::string& override_text, std::size_t equals, int line, bool quoted) {
  std::string text = std::string(static_cast<std::size_t>(line) - 1, '\n') + "v" + std::string(equals - 1, ' ') + "=";
  const std::string value = override_text.substr(equals + 1);
  if (quoted) {
    text += '"';
    for (const char c : value) text += c == '"' || c == '\\' ? std::string{'\\', c} : std::string{c};
    text += '"';
  } else {
    text += value;
  }
  return toml::parse(std::string_view(text), std::string_view(kOverrideName));
}

void apply_override(toml::table& root, const std::string& text, int line, SourceText& source,
                    std::vector<base::Finding>& findings) {
  source.add(kOverrideName, text);
  const Place whole{kOverrideName, line, 1, static_cast<int>(text.size())};
  const auto fail = [&](const std::string& what, std::string remedy) {
    findings.push_back(source.finding(base::Severity::kError, whole, what, std::move(remedy)));
  };
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) return fail("no key=value", "write it like camera.vfov=30");
  const std::vector<Step> steps = parse_path(std::string_view(text).substr(0, equals));
  if (steps.empty()) return fail("this is no key", "write it like camera.vfov=30 or sphere[0].radius=2");
  toml::table parsed;
  try {
    parsed = parse_value(text, equals, line, false);
  } catch (const toml::parse_error&) {
    try {
      parsed = parse_value(text, equals, line, true);  // a word without quotes
    } catch (const toml::parse_error& error) {
      findings.push_back(parse_finding(error, source));
      return;
    }
  }
  toml::node* value = parsed.get("v");
  if (value == nullptr) return fail("no value", "write it like camera.vfov=30");
  if (const std::string fault = put(root, steps, std::move(*value)); !fault.empty()) fail(fault, "");
}

}  // namespace

Place place_of(const toml::node& node) { return place_of(node.source()); }
Place place_of(const toml::key& key) { return place_of(key.source()); }

toml::table parse_tree(const std::string& file_name, const std::string& text, const std::vector<std::string>& overrides,
                       SourceText& source, std::vector<base::Finding>& findings) {
  source.add(file_name, text);
  toml::table root;
  try {
    root = toml::parse(std::string_view(text), std::string_view(file_name));
  } catch (const toml::parse_error& error) {
    findings.push_back(parse_finding(error, source));
    return root;
  }
  int line = 0;
  for (const std::string& override_text : overrides) apply_override(root, override_text, ++line, source, findings);
  return root;
}

}  // namespace orrery::format
