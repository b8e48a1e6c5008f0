// SPDX-License-Identifier: Apache-2.0
#include "format/toml_tree.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <sstream>
#include <tuple>

#include <fmt/core.h>

#include "format/key_depth.h"
#include "format/read_materials.h"
#include "scene/value_text.h"

namespace orrery::format {
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
toml::table& target_of(toml::table& root, const std::optional<Override::Element>& element) {
  if (!element) return root;
  toml::node* const node = root.get(element->list);
  toml::array* const array = node == nullptr ? nullptr : node->as_array();
  if (array == nullptr) throw Fault{fmt::format("the scene has no list `{}`", element->list), kOverrideExample};
  const std::string name = fmt::format("{}[{}]", element->list, element->index);
  if (element->index >= array->size())
    throw Fault{fmt::format("{} does not exist; the scene has {} `{}` tables, counted from 0", name, array->size(),
                            element->list),
                ""};
  toml::table* const table = array->get(element->index)->as_table();
  if (table == nullptr) throw Fault{name + " is not a table", kOverrideExample};
  return *table;
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

void apply_overrides(toml::table& root, const Overrides& overrides, const SourceText& source,
                     Diagnostics& diagnostics) {
  int line = 0;
  for (const Override& override : overrides) {
    ++line;
    try {
      apply_override(root, override, line);
    } catch (const Fault& fault) {
      Place place{kOverrideName, line, std::max(fault.column, 1), 1};
      if (fault.column == 0) place.width = static_cast<int>(override.toml.size());
      diagnostics.add(base::Severity::kError, place, base::ErrorKind::kBadData,
                      [&] { return source.diagnostic(base::Severity::kError, place, fault.text, fault.remedy); });
    }
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
  Override::Fault out{std::string(error.description()), {}, static_cast<int>(error.source().begin.column)};
  constexpr std::string_view kPreface = "Error while parsing ";
  if (out.text.starts_with(kPreface)) out.text.erase(0, kPreface.size());
  if (const std::size_t at = out.text.find("cannot redefine existing"); at != std::string::npos) {
    out.text = "duplicate: " + out.text.substr(at);
    out.remedy = "remove one of them";
  }
  return out;
}

toml::table parse_tree(const std::string& file_name, const std::string& text, const Overrides& overrides,
                       SourceText& source, Diagnostics& diagnostics) {
  source.add(file_name, text);
  source.set_overrides(overrides);
  if (Place place = too_deep_key(text); place.line > 0) {
    place.text_name = file_name;
    diagnostics.add(base::Severity::kError, place, base::ErrorKind::kBadData, [&] {
      return source.diagnostic(base::Severity::kError, place,
                               fmt::format("the key has more than {} parts", kDeepestKey));
    });
    return {};
  }
  toml::table root;
  try {
    root = toml::parse(std::string_view(text), std::string_view(file_name));
  } catch (const toml::parse_error& error) {
    Place place = place_of_region(error.source());
    place.width = 1;
    const Fault fault = fault_of(error);
    diagnostics.add(base::Severity::kError, place, base::ErrorKind::kBadData,
                    [&] { return source.diagnostic(base::Severity::kError, place, fault.text, fault.remedy); });
    return {};
  }
  apply_overrides(root, overrides, source, diagnostics);
  drop_keys_of_old_types(root);
  return root;
}

}  // namespace orrery::format
