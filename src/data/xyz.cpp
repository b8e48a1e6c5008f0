// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "base/text.h"
#include "data/frames.h"
#include "data/readers.h"

namespace orrery::data {

namespace {

/// The values in the second line of a frame of extended XYZ, by key. Quotes and brackets around a value are removed; a
/// key without a value maps to an empty string.
using XyzValues = std::map<std::string, std::string, std::less<>>;

/// A property of the atoms: one column or several.
struct XyzProperty {
  std::string name;
  ColumnType type = ColumnType::kFloat64;
  std::size_t count = 1;
};

constexpr std::string_view kSpace = " \t\r";

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
  const char end = opening == '{' ? '}' : opening == '[' ? ']' : opening;
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

/// Parses "species:S:1:pos:R:3".
///
/// Errors     base::Error(kBadData), thrown through `faults`
std::vector<XyzProperty> xyz_properties(std::string_view text, std::uint64_t line, Faults& faults) {
  const std::string remedy = "expected name:type:columns, repeated; types are S, I, R and L";
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
      faults.fail(line, shown + "its name, type or number of columns is missing", remedy);
    if (parts[i + 1] == "R")
      property.type = ColumnType::kFloat64;
    else if (parts[i + 1] == "I")
      property.type = ColumnType::kInt64;
    else if (parts[i + 1] == "S" || parts[i + 1] == "L")
      property.type = ColumnType::kText;
    else
      faults.fail(line, fmt::format("{}unknown type '{}'", shown, parts[i + 1]), remedy);
    std::int64_t count = 0;
    if (!parse_integer(parts[i + 2], count) || count < 1 || count > kMaxCount || (columns += count) > kMaxCount)
      faults.fail(line,
                  fmt::format("{}'{}' is not a number of columns; at most {} in all", shown, parts[i + 2], kMaxCount),
                  remedy);
    property.count = static_cast<std::size_t>(count);
    out.push_back(std::move(property));
  }
  return out;
}

/// Reads `Lattice`, `pbc` and `Origin`.
///
/// Result     empty without a lattice
/// Errors     base::Error(kBadData), thrown through `faults`
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

constexpr std::size_t kMaxShown = 60;
const std::array<std::string, 3> kXyz = {"x", "y", "z"};

/// A line with nothing but a number of atoms.
bool parse_count(std::string_view line, std::int64_t& count) {
  const auto words = words_of(line);
  return words.size() == 1 && parse_integer(words[0], count) && count >= 0;
}

class XyzHeaderReader {
 public:
  XyzHeaderReader(const ByteSource& bytes, TextCursor cursor) : cursor_(cursor), faults_(bytes.file()) {}

  TextFrame read() {
    std::string line;
    cursor_.next_filled(line);
    out_.count_line = cursor_.line() - 1;
    std::int64_t rows = 0;
    parse_count(line, rows);
    out_.info.rows = out_.layout.rows = static_cast<std::uint64_t>(rows);
    cursor_.next(line);
    comment_line_ = cursor_.line() - 1;
    out_.layout.begin = cursor_.offset();
    out_.layout.first_line = cursor_.line();
    std::string first;
    if (rows > 0) cursor_.next(first);
    const XyzValues values = xyz_values(line);
    out_.info.box = xyz_box(values, comment_line_, faults_);
    for (const char* const key : {"Timestep", "timestep", "Step", "step"})
      if (double step = 0; values.count(key) > 0 && parse_number(values.at(key), step) && std::isfinite(step))
        out_.info.step = step;
    for (const auto& [key, value] : values)
      if (double number = 0; parse_number(value.substr(0, value.find(',')), number) && std::isfinite(number))
        out_.info.header.emplace_back(key, number);  // CP2K writes `time = 0.5, E = -17.1`
    const auto properties = values.find("Properties");
    if (properties != values.end()) {
      add_properties(xyz_properties(properties->second, comment_line_, faults_), words_of(first));
    } else {
      out_.info.title = line;
      add_plain(words_of(first));
    }
    out_.layout.columns = out_.info.columns;
    return std::move(out_);
  }

 private:
  using Parts = std::vector<std::string_view>;

  /// Adds a column, under another name if there is one with this name. Returns its name.
  std::string add(const std::string& name, ColumnType type) {
    out_.info.columns.push_back({names_.add(name), type});
    return out_.info.columns.back().name;
  }
  std::array<std::string, 3> add_three(const std::array<std::string, 3>& names, ColumnType type) {
    return {add(names[0], type), add(names[1], type), add(names[2], type)};
  }

  /// Elements or types: some programs interpret numbers in the element column as atomic numbers, others as types. Names
  /// are elements if all of them are, see FrameInfo::names_as_types.
  void set_species(const std::string& name, const Parts& first, std::size_t column) {
    std::int64_t ignored = 0;
    const bool is_number = column < first.size() && parse_integer(first[column], ignored);
    (is_number ? out_.info.roles.type : out_.info.roles.element) = name;
    if (!is_number) out_.info.names_as_types = name;
  }

  void add_properties(const std::vector<XyzProperty>& properties, const Parts& first) {
    Roles& roles = out_.info.roles;
    std::string diameter;
    for (const XyzProperty& p : properties) {
      if (p.name == "pos") {
        if (p.count != 3 || p.type != ColumnType::kFloat64)
          faults_.fail(comment_line_, "property \"pos\" does not have 3 real components", "write pos:R:3");
        roles.position = add_three(kXyz, p.type);
        continue;
      }
      if (p.name == "color" && p.count == 3 && p.type == ColumnType::kFloat64) {
        roles.rgb = add_three({"color[1]", "color[2]", "color[3]"}, p.type);
        roles.rgb_maximum = 1;
        continue;
      }
      if (p.count == 1) {
        const std::size_t column = out_.info.columns.size();
        const std::string name = add(p.name, p.type);
        const bool is_number = p.type != ColumnType::kText;
        if (p.name == "species" && !is_number) set_species(name, first, column);
        if (p.name == "type" || (p.name == "species" && is_number)) roles.type = name;
        if (p.name == "id" && is_number) roles.id = name;
        if (p.name == "radius" && is_number) roles.radius = name;
        if (p.name == "diameter" && is_number) diameter = name;
        continue;
      }
      for (std::size_t i = 1; i <= p.count; ++i) add(fmt::format("{}[{}]", p.name, i), p.type);
    }
    if (roles.radius.empty() && !diameter.empty()) {
      roles.radius = diameter;
      roles.radius_scale = 0.5;
    }
    if (roles.rgb[0].empty()) {
      const Roles customary = customary_roles(out_.info.columns);
      roles.rgb = customary.rgb;
      roles.rgb_maximum = customary.rgb_maximum;
    }
    if (roles.position[0].empty())
      faults_.fail(comment_line_, "Properties has no positions", "write for example Properties=species:S:1:pos:R:3");
  }

  void add_plain(const Parts& first) {
    out_.layout.allows_more = true;  // rows may have anything after the position
    set_species("element", first, 0);
    if (out_.info.roles.element.empty()) {
      out_.info.roles.type = "type";
      add("type", ColumnType::kInt64);
    } else {
      add("element", ColumnType::kText);
      out_.info.names_as_types = "type";  // the column has no name in the file
    }
    out_.info.roles.position = add_three(kXyz, ColumnType::kFloat64);
    for (std::size_t i = 4; i < std::min<std::size_t>(first.size(), kMaxColumns); ++i) {
      double ignored = 0;
      add("column" + std::to_string(i + 1), parse_number(first[i], ignored) ? ColumnType::kFloat64 : ColumnType::kText);
    }
  }

  TextCursor cursor_;
  Faults faults_;
  UniqueNames names_;
  TextFrame out_;
  std::uint64_t comment_line_ = 0;
};

class Xyz final : public TextFrames {
 public:
  Xyz(const Bytes& bytes, const OpenOptions& options) : TextFrames(bytes, options) {}

  Table read(int number, const std::vector<std::string>& columns) override {
    TextFrame frame = this->frame(number);
    TextLayout& layout = frame.layout;
    layout.wanted = columns;
    if (layout.allows_more && base::contains(columns, frame.info.names_as_types))
      layout.columns[0].name = frame.info.names_as_types;
    constexpr std::size_t kPlainColumns = 4;
    while (layout.allows_more && layout.columns.size() > kPlainColumns &&
           !base::contains(columns, layout.columns.back().name))
      layout.columns.pop_back();
    return read_rows(frame);
  }

 private:
  TextFrame header(TextCursor cursor) override { return XyzHeaderReader(bytes(), std::move(cursor)).read(); }

  std::uint64_t skip_header(TextCursor& cursor) const override {
    std::string line;
    cursor.next_filled(line);
    std::int64_t count = 0;
    if (!parse_count(line, count))
      Faults(bytes().file())
          .fail(cursor.line() - 1, fmt::format("expected a number of atoms, found '{}'", line.substr(0, kMaxShown)),
                "check the number of atoms of the previous frame");
    cursor.skip(1);
    return static_cast<std::uint64_t>(count);
  }

  bool begins_frame(std::string_view line) const override {
    std::int64_t ignored = 0;
    return parse_count(line, ignored);
  }
};

bool is_xyz(const Signature& signature) {
  const std::string_view head = signature.head;
  const std::size_t first = head.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) return false;
  const std::size_t end = std::min(head.find('\n', first), head.size());
  std::int64_t ignored = 0;
  if (!parse_count(head.substr(first, end - first), ignored)) return false;
  if (signature.extension == ".xyz" || signature.extension == ".extxyz" || signature.extension == ".exyz") return true;
  const std::string_view comment = head.substr(end, std::min(head.find('\n', end + 1), head.size()) - end);
  return comment.find("Properties=") != std::string_view::npos;
}

}  // namespace

const FormatReader kXyz = {"XYZ", is_xyz, open_as<Xyz>};

}  // namespace orrery::data
