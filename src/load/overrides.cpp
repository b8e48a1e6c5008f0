// SPDX-License-Identifier: Apache-2.0
#include "load/overrides.h"

#include <algorithm>
#include <cctype>
#include <sstream>
#include <utility>

#include <fmt/core.h>

#include "load/toml_tree.h"
#include "scene/value_text.h"

namespace orrery::load {
namespace {

using Fault = Override::Fault;

/// The parts of "sphere[2].radius=0.5".
struct Parts {
  std::string_view list;  ///< "sphere[2]"; empty if the key names no list element
  std::string_view key, value;
};

/// Finds the "=" between key and value and the last "]" of the key, both outside quotes.
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
      if (i == 0) throw Fault{"no key before the =", kOverrideExample};
      if (list_end == 0) return {{}, text.substr(0, i), text.substr(i + 1)};
      const std::size_t dot = text.find_first_not_of(" \t", list_end);
      if (text[dot] != '.')
        throw Fault{"a list element cannot be set as a whole", "set one of its keys, e.g. sphere[0].radius=2"};
      return {text.substr(0, list_end), text.substr(dot + 1, i - dot - 1), text.substr(i + 1)};
    }
  }
  throw Fault{"not of the form KEY=VALUE", kOverrideExample};
}

/// "sphere[2]" without quotes and blanks.
std::string element_of(std::string_view text) {
  const std::size_t open = std::min(text.find('['), text.size());
  std::string list(text.substr(0, open));
  try {
    const toml::table name = toml::parse(list + "=0");
    // A name that begins with # makes a comment, and an empty table.
    if (!name.empty() && name.begin()->second.is_integer()) list = name.begin()->first.str();
  } catch (const toml::parse_error&) {  // no list has such a name
  }
  return list.append(text.substr(open));
}

std::string_view trimmed(std::string_view text) {
  constexpr const char* kBlanks = " \t";
  text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
  return text.substr(0, text.find_last_not_of(kBlanks) + 1);
}

/// True for an element that needs no quotes: it does not begin with a letter, or is a TOML keyword.
bool is_bare_value(std::string_view element) {
  return !element.empty() && (std::isalpha(static_cast<unsigned char>(element.front())) == 0 || element == "true" ||
                              element == "false" || element == "inf" || element == "nan");
}

/// Quotes the words of a list such as "[Z, N]"; empty if `value` is not such a list.
std::string quoted_list(std::string_view value) {
  if (value.size() < 2 || value.front() != '[' || value.back() != ']') return {};
  std::istringstream words(std::string(value.substr(1, value.size() - 2)));
  if (words.str().find_first_of("[]{}\"'#") != std::string::npos) return {};
  std::string out = "[";
  for (std::string element; std::getline(words, element, ',');) {
    const std::string word(trimmed(element));
    if (words.eof() && word.empty()) break;  // after the last comma
    out += (is_bare_value(word) ? word : scene::string_text(word)) + ", ";
  }
  return out + ']';
}

/// Parses key and value, which may be a word or a list of words without quotes.
toml::table parse_override(const Parts& parts, Override& out) {
  const std::string_view value = trimmed(parts.value);
  if (value.empty()) throw Fault{"no value after the =", kOverrideExample};
  const auto parsed = [&](std::string_view as_toml) {
    out.toml = fmt::format("{}={}", parts.key, as_toml);
    return toml::parse(out.toml);
  };
  try {
    return parsed(value);
  } catch (const toml::parse_error&) {
    try {
      if (const std::string list = quoted_list(value); !list.empty()) return parsed(list);
    } catch (const toml::parse_error&) {  // refers to text that was not typed; the first error counts
    }
    const bool can_only_be_toml = std::string_view("[{\"'").find(value.front()) != std::string_view::npos;
    if (can_only_be_toml) return parsed(value);
  }
  return parsed(scene::string_text(std::string(value)));
}

KeyValue::Value scalar_of(const toml::node& node) {
  if (const auto* const text = node.as_string()) return text->get();
  if (const auto* const number = node.as_integer()) return number->get();
  if (const auto* const number = node.as_floating_point()) return number->get();
  if (const auto* const truth = node.as_boolean()) return truth->get();
  return {};
}

/// Adds the keys of a table. `name` and `text` precede them: "sphere[2]."
void flatten(const toml::table& table, const std::string& name, const std::string& text, std::vector<KeyValue>& out) {
  for (const auto& [key, node] : table) {
    const std::string inner_name = name + std::string(key.str()), inner_text = text + toml_text(key);
    if (const toml::table* const inner = node.as_table()) {
      flatten(*inner, inner_name + '.', inner_text + '.', out);
    } else {
      out.push_back({inner_name, fmt::format("{}={}", inner_text, toml_text(node)), scalar_of(node)});
    }
  }
}

/// Parses the text of an override.
void read_override(const std::string& text, Override& out) {
  out.toml = text;
  try {
    if (text.find_first_of("\r\n") != std::string::npos) throw Fault{"an override must be one line", kOverrideExample};
    // TOML allows one at the beginning of a file only, and an override is parsed below empty lines.
    if (text.starts_with("\xEF\xBB\xBF")) throw Fault{"the key begins with a byte order mark", kOverrideExample};
    if (too_deep_key(text).line > 0)
      throw Fault{fmt::format("the key has more than {} parts", kDeepestKey), kOverrideExample};
    const Parts parts = parts_of(text);
    if (!parts.list.empty()) out.element = element_of(parts.list);
    const std::string prefix = out.element.empty() ? "" : out.element + '.';
    const toml::table set = parse_override(parts, out);
    if (set.empty()) throw Fault{"the key begins with #, as a comment does", kOverrideExample};
    flatten(set, prefix, prefix, out.values);
  } catch (const Fault& found) {
    out.fault = found;
  } catch (const toml::parse_error& error) {
    out.fault = fault_of(error);
  }
}

}  // namespace

bool Override::sets(std::string_view key) const {
  return std::any_of(values.begin(), values.end(), [&](const KeyValue& set) {
    return key.starts_with(set.key) &&
           (key.size() == set.key.size() || key[set.key.size()] == '.' || key[set.key.size()] == '[');
  });
}

void Overrides::add(const std::string& key_and_value, bool replaces) {
  Override& out = list_.emplace_back();
  out.option = "--set";
  out.typed = key_and_value;
  out.replaces = replaces;
  read_override(key_and_value, out);
}

void Overrides::add_option(const std::string& option, const std::string& key, const std::string& typed, bool is_list) {
  Override& out = list_.emplace_back();
  out.option = option;
  out.typed = typed;
  read_override(key + (is_list ? "=[" + typed + "]" : "=" + typed), out);
}

bool Overrides::sets(std::string_view key) const {
  return std::any_of(list_.begin(), list_.end(), [&](const Override& one) { return one.sets(key); });
}

std::vector<KeyValue> Overrides::values() const {
  std::vector<KeyValue> out;
  for (const Override& one : list_)
    for (const KeyValue& set : one.values) {
      std::erase_if(out, [&](const KeyValue& before) { return before.key == set.key; });
      out.push_back(set);
    }
  return out;
}

template <class T>
std::optional<T> Overrides::value(std::string_view key) const {
  std::optional<T> out;
  for (const Override& one : list_)
    for (const KeyValue& set : one.values)
      if (set.key == key)
        out = std::holds_alternative<T>(set.value) ? std::optional(std::get<T>(set.value)) : std::nullopt;
  return out;
}

std::optional<std::int64_t> Overrides::integer(std::string_view key) const { return value<std::int64_t>(key); }
std::optional<double> Overrides::number(std::string_view key) const {
  if (const auto whole = integer(key)) return static_cast<double>(*whole);
  return value<double>(key);
}
std::optional<std::string> Overrides::string(std::string_view key) const { return value<std::string>(key); }

}  // namespace orrery::load
