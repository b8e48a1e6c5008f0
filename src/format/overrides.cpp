// SPDX-License-Identifier: Apache-2.0
#include "format/overrides.h"

#include <algorithm>
#include <charconv>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include "format/key_depth.h"
#include "format/toml_tree.h"

namespace orrery::format {
namespace {

constexpr const char* kExample = "write it like camera.vfov=30 or sphere[0].radius=2";

/// What is wrong with an override as a whole, and what to do.
struct Fault {
  std::string text, remedy = kExample;
};

/// "sphere[2].radius=0.5" taken apart.
struct Parts {
  std::string_view list;      ///< "sphere[2]"; empty where no element of a list is named
  std::size_t key_begin = 0;  ///< of "radius"
  std::size_t equals = 0;     ///< of "="
};

/// Finds the "=" between key and value, and the last "]" of the key, outside of quotes.
Parts parts_of(std::string_view text) {
  char quote = 0;
  std::size_t list_end = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quote != 0) {
      if (c == '\\' && quote == '"') ++i;
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == ']') {
      list_end = i + 1;
    } else if (c == '=') {
      if (i == 0) throw Fault{"there is no key before the ="};
      if (list_end == 0) return {{}, 0, i};
      if (text[list_end] != '.')
        throw Fault{"an element of a list is not set as a whole", "name one of its keys, like sphere[0].radius=2"};
      return {text.substr(0, list_end), list_end + 1, i};
    }
  }
  throw Fault{"this is no key=value"};
}

/// The table that "sphere[2]" names.
toml::table& element_of(toml::table& root, std::string_view list) {
  const std::size_t open = list.find('[');
  const std::string name(list.substr(0, open));
  std::size_t index = 0;
  const char* const digits = list.data() + std::min(open + 1, list.size());
  const char* const end = list.data() + list.size() - 1;  // the "]"
  const auto [stop, fault] = std::from_chars(digits, end, index);
  if (open == std::string_view::npos || fault != std::errc() || stop != end)
    throw Fault{"`" + std::string(list) + "` is no element of a list"};
  toml::node* node = root.get(name);
  toml::array* array = node == nullptr ? nullptr : node->as_array();
  if (array == nullptr) throw Fault{"the scene has no list `" + name + "`"};
  if (index >= array->size())
    throw Fault{"there is no " + std::string(list) + "; the scene has " + std::to_string(array->size()) + " of `" +
                    name + "`, counted from 0",
                ""};
  toml::table* element = array->get(index)->as_table();
  if (element == nullptr) throw Fault{std::string(list) + " is no table"};
  return *element;
}

bool is_blank(std::string_view text) { return text.find_first_not_of(" \t") == std::string_view::npos; }

/// True where a value can only be meant as TOML: then what is wrong with it is worth telling.
bool looks_like_toml(std::string_view value) {
  const std::size_t begin = value.find_first_not_of(" \t");
  return begin != std::string_view::npos && std::string_view("[{\"'").find(value[begin]) != std::string_view::npos;
}

std::string in_quotes(std::string_view word) {
  std::string out = "\"";
  for (const char c : word) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + '"';
}

/// Key and value as a tree of their own. What stands before is filled with blanks, so that places are those of `text`.
toml::table parse_override(const std::string& text, const Parts& parts, int line) {
  const std::string filled(static_cast<std::size_t>(line) - 1, '\n');
  const std::string key =
      filled + std::string(parts.key_begin, ' ') + text.substr(parts.key_begin, parts.equals + 1 - parts.key_begin);
  const std::string value = text.substr(parts.equals + 1);
  if (is_blank(value)) throw Fault{"there is no value behind the ="};
  try {
    return toml::parse(std::string_view(key + value), std::string_view(kOverrideName));
  } catch (const toml::parse_error&) {
    if (looks_like_toml(value)) throw;
  }
  return toml::parse(std::string_view(key + in_quotes(value)), std::string_view(kOverrideName));
}

/// Moves `from` into `to`. Tables that only a dotted key made are gone into, a table that is the value replaces.
void merge(toml::table& to, toml::table& from) {
  for (auto&& [key, node] : from) {
    toml::table* const inner = node.as_table();
    toml::node* const there = to.get(key.str());
    if (inner != nullptr && !inner->is_inline() && there != nullptr) {
      if (toml::table* table = there->as_table()) {
        merge(*table, *inner);
        continue;
      }
      throw Fault{"`" + std::string(key.str()) + "` is no table",
                  there->is_array() ? "name one of its elements, like sphere[0].radius=2" : ""};
    }
    node.visit([&to, &name = key](auto& value) { to.insert_or_assign(name, std::move(value)); });
  }
}

void apply_override(toml::table& root, const std::string& text, int line) {
  if (text.find_first_of("\r\n") != std::string::npos) throw Fault{"an override is one line"};
  if (too_deep_key(text).line > 0) throw Fault{"a key of more than " + std::to_string(kDeepestKey) + " parts"};
  const Parts parts = parts_of(text);
  toml::table& target = parts.list.empty() ? root : element_of(root, parts.list);
  toml::table parsed = parse_override(text, parts, line);
  merge(target, parsed);
}

}  // namespace

void apply_overrides(toml::table& root, const std::vector<std::string>& overrides, SourceText& source,
                     std::vector<base::Finding>& findings) {
  int line = 0;
  for (const std::string& text : overrides) {
    std::string shown = text;  // one line of the text of all overrides, whatever is in it
    std::replace_if(
        shown.begin(), shown.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
    source.add(kOverrideName, shown);
    ++line;
    try {
      apply_override(root, text, line);
    } catch (const Fault& fault) {
      const Place whole{kOverrideName, line, 1, static_cast<int>(text.size())};
      findings.push_back(source.finding(base::Severity::kError, whole, fault.text, fault.remedy));
    } catch (const toml::parse_error& error) {
      findings.push_back(parse_finding(error, source));
    }
  }
}

}  // namespace orrery::format
