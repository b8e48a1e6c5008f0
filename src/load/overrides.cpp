// SPDX-License-Identifier: Apache-2.0
#include "load/overrides.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <numeric>
#include <system_error>
#include <utility>

#include <fmt/core.h>

#include "load/toml_tree.h"

namespace orrery::load {
namespace {

using Fault = Override::Fault;

/// The parts of "sphere[2].radius=0.5".
struct Parts {
  std::string_view list;      ///< "sphere[2]"; empty if the key names no list element
  std::size_t key_begin = 0;  ///< offset of "radius"
  std::size_t equals = 0;     ///< offset of "="
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
      if (list_end == 0) return {{}, 0, i};
      const std::size_t dot = text.find_first_not_of(" \t", list_end);
      if (text[dot] != '.')
        throw Fault{"a list element cannot be set as a whole", "set one of its keys, e.g. sphere[0].radius=2"};
      return {text.substr(0, list_end), dot + 1, i};
    }
  }
  throw Fault{"not of the form KEY=VALUE", kOverrideExample};
}

/// Parses "sphere[2]".
Override::Element element_of(std::string_view text) {
  const std::size_t open = std::min(text.find('['), text.size() - 1);
  Override::Element out{{}, 0};
  const char* const last = text.data() + text.size() - 1;  // the "]"
  const auto [stop, fault] = std::from_chars(text.data() + open + 1, last, out.index);
  if (text[open] != '[' || fault != std::errc() || stop != last)
    throw Fault{fmt::format("`{}` is not a list element", text), kOverrideExample};
  try {
    const toml::table name = toml::parse(std::string(text.substr(0, open)) + "=0");
    // A name that begins with # makes a comment, and an empty table.
    if (!name.empty() && name.begin()->second.is_integer()) out.list = name.begin()->first.str();
  } catch (const toml::parse_error&) {  // no list has such a name
  }
  if (out.list.empty()) out.list = text.substr(0, open);
  return out;
}

bool is_blank(std::string_view text) { return text.find_first_not_of(" \t") == std::string_view::npos; }

/// True if a value can only be meant as TOML, so that its syntax error is worth reporting.
bool looks_like_toml(std::string_view value) {
  const std::size_t begin = value.find_first_not_of(" \t");
  return begin != std::string_view::npos && std::string_view("[{\"'").find(value[begin]) != std::string_view::npos;
}

/// A string with inserted bytes, which must not be counted in columns of messages.
struct Quoted {
  std::string text;
  std::vector<std::size_t> inserted;

  void insert(char c) {
    inserted.push_back(text.size());
    text += c;
  }
  void quote(std::string_view word) {
    insert('"');
    for (const char c : word) {
      if (c == '"' || c == '\\') insert('\\');
      text += c;
    }
    insert('"');
  }
};

/// True for an element that needs no quotes: it does not begin with a letter, or is a TOML keyword.
bool is_bare_value(std::string_view element) {
  const auto first = static_cast<unsigned char>(element.front());
  return std::isalpha(first) == 0 || element == "true" || element == "false" || element == "inf" || element == "nan";
}

/// Quotes the words of a list such as "[Z, N]"; false if `value` is not such a list.
bool quote_list(std::string_view value, Quoted& out) {
  constexpr const char* kBlanks = " \t";
  const std::size_t begin = value.find_first_not_of(kBlanks), end = value.find_last_not_of(kBlanks);
  if (begin == std::string_view::npos || begin == end || value[begin] != '[' || value[end] != ']') return false;
  const std::string_view elements = value.substr(begin + 1, end - begin - 1);
  if (elements.find_first_of("[]{}\"'#") != std::string_view::npos) return false;
  out.text += value.substr(0, begin + 1);
  for (std::size_t at = 0; at < elements.size();) {
    const std::size_t comma = std::min(elements.find(',', at), elements.size());
    const std::string_view element = elements.substr(at, comma - at);
    const std::size_t first = std::min(element.find_first_not_of(kBlanks), element.size());
    const std::size_t last = element.find_last_not_of(kBlanks) + 1;  // 0 if there are only blanks
    const std::string_view word = element.substr(first, std::max(last, first) - first);
    out.text += element.substr(0, first);
    const bool is_end = word.empty() && comma == elements.size();  // after the last comma
    if (is_end || (!word.empty() && is_bare_value(word))) {
      out.text += word;
    } else {
      out.quote(word);
    }
    out.text += element.substr(first + word.size());
    if (comma < elements.size()) out.text += ',';
    at = comma + 1;
  }
  out.text += value.substr(end);
  return true;
}

/// Parses key and value. Preceding text is replaced by blanks, so that locations are those of `text`.
toml::table parse_override(const std::string& text, const Parts& parts, Override& out) {
  Quoted key{std::string(parts.key_begin, ' ') + text.substr(parts.key_begin, parts.equals + 1 - parts.key_begin),
             out.inserted};
  const std::string value = text.substr(parts.equals + 1);
  if (is_blank(value)) throw Fault{"no value after the =", kOverrideExample};
  const auto parsed = [&](Quoted quoted) {
    out.toml = std::move(quoted.text);
    out.inserted = std::move(quoted.inserted);
    return toml::parse(out.toml);
  };
  const Quoted as_typed{key.text + value, key.inserted};
  try {
    return parsed(as_typed);
  } catch (const toml::parse_error&) {
    if (Quoted list = key; quote_list(value, list)) {
      try {
        return parsed(std::move(list));
      } catch (const toml::parse_error&) {  // refers to text that was not typed; the first error counts
      }
    }
    if (looks_like_toml(value)) return parsed(as_typed);
  }
  key.quote(value);
  return parsed(std::move(key));
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

/// Parses the text of an override, of which the user did not type the first bytes.
void read_override(const std::string& text, std::size_t inserted, Override& out) {
  out.toml = text;
  out.inserted.resize(inserted);
  std::iota(out.inserted.begin(), out.inserted.end(), std::size_t{0});
  try {
    if (text.find_first_of("\r\n") != std::string::npos) throw Fault{"an override must be one line", kOverrideExample};
    // TOML allows one at the beginning of a file only, and an override is parsed below empty lines.
    if (text.starts_with("\xEF\xBB\xBF")) throw Fault{"the key begins with a byte order mark", kOverrideExample};
    if (too_deep_key(text).line > 0)
      throw Fault{fmt::format("the key has more than {} parts", kDeepestKey), kOverrideExample};
    const Parts parts = parts_of(text);
    std::string name, prefix;
    if (!parts.list.empty()) {
      out.element = element_of(parts.list);
      name = prefix = fmt::format("{}[{}].", out.element->list, out.element->index);
    }
    const toml::table set = parse_override(text, parts, out);
    if (set.empty()) throw Fault{"the key begins with #, as a comment does", kOverrideExample};
    flatten(set, name, prefix, out.values);
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
  read_override(key_and_value, 0, out);
}

void Overrides::add_option(const std::string& option, const std::string& key, const std::string& typed, bool is_list) {
  Override& out = list_.emplace_back();
  out.option = option;
  out.typed = typed;
  const std::string before = key + (is_list ? "=[" : "=");
  read_override(before + typed + (is_list ? "]" : ""), before.size(), out);
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
