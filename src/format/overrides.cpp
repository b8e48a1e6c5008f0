// SPDX-License-Identifier: Apache-2.0
#include "format/overrides.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/core.h>

#include "format/key_depth.h"
#include "format/toml_tree.h"

namespace orrery::format {
namespace {

constexpr const char* kExample = "write KEY=VALUE, e.g. camera.vfov=30 or sphere[0].radius=2";

/// An error of an override as a whole, and its remedy.
struct Fault {
  std::string text, remedy = kExample;
};

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
      if (i == 0) throw Fault{"no key before the ="};
      if (list_end == 0) return {{}, 0, i};
      if (text[list_end] != '.')
        throw Fault{"a list element cannot be set as a whole", "set one of its keys, e.g. sphere[0].radius=2"};
      return {text.substr(0, list_end), list_end + 1, i};
    }
  }
  throw Fault{"not of the form KEY=VALUE"};
}

/// Returns the table that "sphere[2]" names.
toml::table& element_of(toml::table& root, std::string_view list) {
  const std::size_t open = list.find('[');
  const std::string name(list.substr(0, open));
  std::size_t index = 0;
  const char* const digits = list.data() + std::min(open + 1, list.size());
  const char* const end = list.data() + list.size() - 1;  // the "]"
  const auto [stop, fault] = std::from_chars(digits, end, index);
  if (open == std::string_view::npos || fault != std::errc() || stop != end)
    throw Fault{fmt::format("`{}` is not a list element", list)};
  toml::node* node = root.get(name);
  toml::array* array = node == nullptr ? nullptr : node->as_array();
  if (array == nullptr) throw Fault{fmt::format("the scene has no list `{}`", name)};
  if (index >= array->size())
    throw Fault{
        fmt::format("{} does not exist; the scene has {} `{}` tables, counted from 0", list, array->size(), name), ""};
  toml::table* element = array->get(index)->as_table();
  if (element == nullptr) throw Fault{std::string(list) + " is not a table"};
  return *element;
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

/// A parsed override, and its text as passed to the TOML library, with added quotes.
struct Parsed {
  toml::table tree;
  Quoted line;
};

/// Parses key and value into a separate tree. Preceding text is replaced by blanks, so that locations are those of
/// `text`.
Parsed parse_override(const std::string& text, const Parts& parts, int line) {
  const std::string above(static_cast<std::size_t>(line) - 1, '\n');
  const std::string key =
      std::string(parts.key_begin, ' ') + text.substr(parts.key_begin, parts.equals + 1 - parts.key_begin);
  const std::string value = text.substr(parts.equals + 1);
  if (is_blank(value)) throw Fault{"no value after the ="};
  const auto parsed = [&](Quoted quoted) {
    toml::table tree = toml::parse(std::string_view(above + quoted.text), std::string_view(kOverrideName));
    return Parsed{std::move(tree), std::move(quoted)};
  };
  try {
    return parsed({key + value, {}});
  } catch (const toml::parse_error&) {
    Quoted list{key, {}};
    if (quote_list(value, list)) {
      try {
        return parsed(std::move(list));
      } catch (const toml::parse_error&) {  // refers to text that was not typed; the first error counts
      }
    }
    if (looks_like_toml(value)) throw;
  }
  Quoted word{key, {}};
  word.quote(value);
  return parsed(std::move(word));
}

/// Moves `from` into `to`. Tables from dotted keys are merged; an inline table replaces the old value.
void merge(toml::table& to, toml::table& from) {
  for (auto&& [key, node] : from) {
    toml::table* const inner = node.as_table();
    toml::node* const there = to.get(key.str());
    if (inner != nullptr && !inner->is_inline() && there != nullptr) {
      if (toml::table* table = there->as_table()) {
        merge(*table, *inner);
        continue;
      }
      throw Fault{fmt::format("`{}` is not a table", key.str()),
                  there->is_array() ? "name one of its elements, e.g. sphere[0].radius=2" : ""};
    }
    node.visit([&to, &name = key](auto& value) { to.insert_or_assign(name, std::move(value)); });
  }
}

/// Applies one override. Its locations are in `line` of kOverrideName; `given` receives the text that was parsed.
void apply_override(toml::table& root, const std::string& text, int line, Quoted& given) {
  if (text.find_first_of("\r\n") != std::string::npos) throw Fault{"an override must be one line"};
  if (too_deep_key(text).line > 0) throw Fault{fmt::format("the key has more than {} parts", kDeepestKey)};
  const Parts parts = parts_of(text);
  toml::table& target = parts.list.empty() ? root : element_of(root, parts.list);
  Parsed parsed = parse_override(text, parts, line);
  given = std::move(parsed.line);
  merge(target, parsed.tree);
}

}  // namespace

void apply_overrides(toml::table& root, const std::vector<Override>& overrides, SourceText& source,
                     Diagnostics& diagnostics) {
  int line = 0;
  for (const Override& override : overrides) {
    ++line;
    Quoted given{override.text, {}};
    std::optional<Fault> fault;
    std::optional<toml::parse_error> parse_error;
    try {
      apply_override(root, override.text, line, given);
    } catch (const Fault& found) {
      fault = found;
    } catch (const toml::parse_error& error) {
      parse_error = error;
    }
    source.add_override(override, std::move(given.text), std::move(given.inserted));
    if (parse_error) add_parse_error(*parse_error, source, diagnostics);
    if (!fault) continue;
    const Place whole{kOverrideName, line, 1, static_cast<int>(override.text.size())};
    diagnostics.add(base::Severity::kError, whole, base::ErrorKind::kBadData,
                    [&] { return source.diagnostic(base::Severity::kError, whole, fault->text, fault->remedy); });
  }
}

}  // namespace orrery::format
