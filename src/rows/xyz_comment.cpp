// SPDX-License-Identifier: Apache-2.0
#include "rows/xyz_comment.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "data/customary.h"
#include "data/faults.h"
#include "data/text_cursor.h"
#include "data/text_rows.h"

namespace orrery::rows {

using namespace data;  // NOLINT(google-build-using-namespace)

namespace {

constexpr std::string_view kSpace = " \t\r";

char closing(char opening) {
  switch (opening) {
    case '{': return '}';
    case '[': return ']';
    default: return opening;
  }
}

/// Removes a word, or a quoted or bracketed part, from the front of a string and returns it.
std::string taken(std::string_view& text, std::string_view separators) {
  std::string out;
  if (text.empty()) return out;
  const char opening = text[0];
  if (opening != '"' && opening != '\'' && opening != '{' && opening != '[') {
    const std::size_t end = std::min(text.find_first_of(separators), text.size());
    out = text.substr(0, end);
    text.remove_prefix(end);
    return out;
  }
  const char end = closing(opening);
  std::size_t depth = 0;
  std::size_t at = 1;
  for (; at < text.size(); ++at) {
    if (text[at] == end && depth == 0) break;
    if (end != opening && text[at] == opening) ++depth;
    if (end != opening && text[at] == end) --depth;
    if (text[at] == '\\' && opening == '"' && at + 1 < text.size()) ++at;
    out += text[at];
  }
  text.remove_prefix(std::min(at + 1, text.size()));
  return out;
}

/// The elements of a list or of a list of lists.
std::vector<std::string> elements(std::string text) {
  for (char& c : text)
    if (c == '[' || c == ']' || c == '{' || c == '}' || c == ',') c = ' ';
  const auto words = words_of(text);
  return {words.begin(), words.end()};
}

const std::string* find(const XyzValues& values, std::initializer_list<std::string_view> keys) {
  for (const std::string_view key : keys)
    if (const auto at = values.find(key); at != values.end()) return &at->second;
  return nullptr;
}

/// The numbers of a value; nothing unless there are `count` finite ones.
std::optional<std::vector<double>> numbers(const std::string& value, std::size_t count) {
  std::vector<double> out;
  for (const std::string& word : elements(value)) {
    double number = 0;
    if (!parse_number(word, number) || !std::isfinite(number)) return std::nullopt;
    out.push_back(number);
  }
  return out.size() == count ? std::optional(out) : std::nullopt;
}

}  // namespace

XyzValues xyz_values(std::string_view line) {
  XyzValues values;
  for (;;) {
    line.remove_prefix(std::min(line.find_first_not_of(kSpace), line.size()));
    if (line.empty()) return values;
    const std::string key = taken(line, " \t\r=");
    const std::size_t next = std::min(line.find_first_not_of(kSpace), line.size());
    std::string value;
    if (next < line.size() && line[next] == '=') {
      line.remove_prefix(next + 1);
      line.remove_prefix(std::min(line.find_first_not_of(kSpace), line.size()));
      value = taken(line, kSpace);
    }
    values.emplace(key, std::move(value));
  }
}

std::vector<XyzProperty> xyz_properties(std::string_view text, std::uint64_t line, Faults& faults) {
  constexpr std::string_view kRemedy = "expected name:type:columns, repeated; types are S, I, R and L";
  std::vector<std::string_view> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(':', begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  std::vector<XyzProperty> out;
  constexpr auto kMaxCount = static_cast<std::int64_t>(kMaxColumns);
  std::int64_t columns = 0;
  for (std::size_t i = 0; i < parts.size(); i += 3) {
    XyzProperty property;
    property.name = parts[i];
    const std::string shown = fmt::format("property \"{}\": ", property.name);
    if (property.name.empty() || parts.size() - i < 3)
      faults.fail(line, shown + "its name, type or number of columns is missing", std::string(kRemedy));
    if (parts[i + 1] == "R")
      property.type = ColumnType::kFloat64;
    else if (parts[i + 1] == "I")
      property.type = ColumnType::kInt64;
    else if (parts[i + 1] == "S" || parts[i + 1] == "L")
      property.type = ColumnType::kText;
    else
      faults.fail(line, fmt::format("{}unknown type '{}'", shown, parts[i + 1]), std::string(kRemedy));
    std::int64_t count = 0;
    if (!parse_integer(parts[i + 2], count) || count < 1 || count > kMaxCount || (columns += count) > kMaxCount)
      faults.fail(line,
                  fmt::format("{}'{}' is not a number of columns; at most {} in all", shown, parts[i + 2], kMaxCount),
                  std::string(kRemedy));
    property.count = static_cast<std::size_t>(count);
    out.push_back(std::move(property));
  }
  return out;
}

std::optional<Box> xyz_box(const XyzValues& values, std::uint64_t line, Faults& faults) {
  const std::string* const lattice = find(values, {"Lattice", "lattice"});
  if (lattice == nullptr) return std::nullopt;
  const auto edges = numbers(*lattice, 9);
  // Without properties, the comment may be a sentence about a lattice.
  if (!edges && find(values, {"Properties", "properties"}) == nullptr && elements(*lattice).size() < 2)
    return std::nullopt;
  if (!edges)
    faults.fail(line, "`Lattice` must be 9 numbers, three vectors", "write Lattice=\"ax ay az bx by bz cx cy cz\"");
  Box box;
  for (std::size_t i = 0; i < 3; ++i) box.edges[i] = {(*edges)[3 * i], (*edges)[3 * i + 1], (*edges)[3 * i + 2]};
  if (const std::string* const origin = find(values, {"Origin", "origin"}); origin != nullptr) {
    const auto xyz = numbers(*origin, 3);
    if (!xyz) faults.fail(line, "`Origin` must be 3 numbers");
    box.origin = {(*xyz)[0], (*xyz)[1], (*xyz)[2]};
  }
  if (const std::string* const pbc = find(values, {"pbc", "PBC"}); pbc != nullptr) {
    const auto flags = elements(*pbc);
    if (flags.size() != 3) faults.fail(line, "`pbc` must be 3 values", "write for example pbc=\"T T F\"");
    for (std::size_t i = 0; i < 3; ++i) {
      const bool is_true = flags[i] == "1" || flags[i][0] == 'T' || flags[i][0] == 't';
      if (!is_true && flags[i] != "0" && flags[i][0] != 'F' && flags[i][0] != 'f')
        faults.fail(line, fmt::format("pbc: '{}' is neither T nor F", flags[i]));
      box.periodic[i] = is_true;
    }
  }
  return box;
}

}  // namespace orrery::rows
