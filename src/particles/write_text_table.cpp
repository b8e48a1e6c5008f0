// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <string_view>
#include <type_traits>
#include <utility>

#include <fmt/core.h>

#include "data/quoted_word.h"
#include "particles/table_output.h"

namespace orrery::particles {

using namespace data;  // NOLINT(google-build-using-namespace)

namespace {

/// Appends the shortest digits that read back to the same number.
template <class T>
void append_number(std::string& out, T value) {
  constexpr std::size_t kLongestNumber = 32;
  char text[kLongestNumber];
  if constexpr (std::is_floating_point_v<T>) {
    if (std::isnan(value)) {
      out += "nan";
      return;
    }
    // A float32 is read back as float64, so the shortest digits of the float32 would give a different number.
    out.append(text, std::to_chars(text, text + kLongestNumber, static_cast<double>(value)).ptr);
  } else {
    out.append(text, std::to_chars(text, text + kLongestNumber, +value).ptr);
  }
}

/// Appends a value; `append_text(out, word)` appends a string.
template <class AppendText>
void append_value(std::string& out, const Column& column, std::size_t row, AppendText append_text) {
  std::visit(
      [&](const auto& values) {
        if constexpr (requires { values.index; }) {
          append_text(out, values.words[values.index[row]]);
        } else {
          append_number(out, values[row]);
        }
      },
      column.values);
}

void append_quoted(std::string& out, std::string_view text) {
  out += '"';
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  out += '"';
}

/// Refuses strings with line breaks.
void check_csv_texts(const base::OutputFile& out, const Column& column, std::string_view line_ends) {
  const auto* const words = std::get_if<Words>(&column.values);
  if (words == nullptr) return;
  for (const std::string& word : words->words)
    if (word.find_first_of(line_ends) != std::string::npos)
      refuse_to_write(out.path(),
                      fmt::format("CSV cannot store the text {} of column {}; write .npy, or leave the column out",
                                  quoted_word(word), quoted_word(column.name)));
}

/// Returns whether XYZ, in which spaces separate values, can store the values of a column.
bool is_storable_in_xyz(const Column& column) {
  const auto* const words = std::get_if<Words>(&column.values);
  return words == nullptr || std::all_of(words->words.begin(), words->words.end(), [](const std::string& word) {
           return !word.empty() && word.find_first_of(" \t\r\n\"") == std::string::npos;
         });
}

/// A property of extended XYZ: one or more columns.
struct XyzOutput {
  std::string name;
  std::vector<const Column*> columns;
  char type = 'R';
  bool is_color = false;  ///< 8-bit colours, written as 0 to 1
};

char xyz_type(const Column& column) {
  const ColumnType type = column.type();
  if (type == ColumnType::kText) return 'S';
  return type == ColumnType::kFloat64 || type == ColumnType::kFloat32 ? 'R' : 'I';
}

/// Returns a name without separator characters, and different from the previous ones.
std::string xyz_name(std::string name, std::set<std::string>& used) {
  if (name.empty()) name = "_";
  for (char& c : name)
    if (std::string_view(" \t\r\n:=\"'{}[]\\,").find(c) != std::string_view::npos) c = '_';
  while (!used.insert(name).second) name += '_';
  return name;
}

/// Returns the columns from `first` on that are the components of one property, name[1], name[2] ..; else the first.
XyzOutput property_at(const Table& table, std::size_t first) {
  const Column& column = table.columns[first];
  XyzOutput out{column.name, {&column}, xyz_type(column)};
  if (!column.name.ends_with("[1]")) return out;
  const std::string name = column.name.substr(0, column.name.size() - 3);
  for (std::size_t i = first + 1; i < table.columns.size(); ++i) {
    const Column& next = table.columns[i];
    if (next.name != fmt::format("{}[{}]", name, i - first + 1) || xyz_type(next) != out.type ||
        !is_storable_in_xyz(next))
      break;
    out.columns.push_back(&next);
  }
  if (out.columns.size() > 1) out.name = name;
  return out;
}

/// Returns the 8-bit colours at a column, as the property `color`, which other programs understand; empty if it is
/// another column.
std::optional<XyzOutput> color_at(const Table& table, std::size_t first) {
  XyzOutput out{"color", {}, 'R', true};
  for (const char* name : {"red", "green", "blue"}) {
    const std::size_t at = first + out.columns.size();
    if (at >= table.columns.size() || table.columns[at].name != name || table.columns[at].type() != ColumnType::kUint8)
      return {};
    out.columns.push_back(&table.columns[at]);
  }
  return out;
}

/// Returns the column of chemical elements; null if there is none that XYZ can store.
const Column* element_of(const Table& table) {
  for (const char* name : {"element", "species", "symbol"})
    if (const Column* const column = table.find(name);
        column != nullptr && column->type() == ColumnType::kText && is_storable_in_xyz(*column))
      return column;
  return nullptr;
}

/// Returns the properties: species, pos, then the other columns in their order. Adds the names of columns that XYZ
/// cannot store to `left_out`.
std::vector<XyzOutput> xyz_outputs(const Table& table, std::vector<std::string>& left_out) {
  std::vector<XyzOutput> out;
  const Column* const element = element_of(table);
  if (element != nullptr) out.push_back({"species", {element}, 'S'});
  out.push_back({"pos", {table.find("x"), table.find("y"), table.find("z")}, 'R'});
  std::set<std::string> used = {"species", "pos"};
  for (std::size_t i = 0; i < table.columns.size();) {
    const std::string& name = table.columns[i].name;
    if (name == "x" || name == "y" || name == "z" || &table.columns[i] == element) {
      ++i;
      continue;
    }
    if (!is_storable_in_xyz(table.columns[i])) {
      left_out.push_back(name);
      ++i;
      continue;
    }
    const std::optional<XyzOutput> color = color_at(table, i);
    XyzOutput property = color ? *color : property_at(table, i);
    i += property.columns.size();
    property.name = xyz_name(property.name, used);
    out.push_back(std::move(property));
  }
  return out;
}

}  // namespace

void write_csv_table(base::OutputFile& out, const Table& table) {
  constexpr std::string_view kLineEnds = "\n\r";
  std::string& text = out.buffer();
  for (const Column& column : table.columns) {
    check_csv_texts(out, column, kLineEnds);
    if (column.name.find_first_of(kLineEnds) != std::string::npos)
      refuse_to_write(out.path(),
                      fmt::format("the name of column {} has a line end; rename it", quoted_word(column.name)));
    if (!text.empty()) text += ',';
    if (column.name.find_first_of(" \t,;\"") == std::string::npos) {
      text += column.name;
    } else {
      append_quoted(text, column.name);
    }
  }
  text += '\n';
  for (std::size_t row = 0; row < table.rows; ++row) {
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      if (c > 0) text += ',';
      append_value(text, table.columns[c], row, append_quoted);
    }
    text += '\n';
    out.flush();
  }
}

std::vector<std::string> write_xyz_table(base::OutputFile& out, const Table& table) {
  std::string& text = out.buffer();
  std::vector<std::string> left_out;
  const std::vector<XyzOutput> properties = xyz_outputs(table, left_out);
  text = fmt::format("{}\nProperties=", table.rows);
  for (const XyzOutput& property : properties) {
    if (&property != &properties.front()) text += ':';
    text += fmt::format("{}:{}:{}", property.name, property.type, property.columns.size());
  }
  text += '\n';
  for (std::size_t row = 0; row < table.rows; ++row) {
    bool is_first = true;
    for (const XyzOutput& property : properties)
      for (const Column* const column : property.columns) {
        if (!is_first) text += ' ';
        is_first = false;
        if (property.is_color)
          append_number(text, column->number(row) / std::numeric_limits<std::uint8_t>::max());
        else
          append_value(text, *column, row, [](std::string& to, const std::string& word) { to += word; });
      }
    text += '\n';
    out.flush();
  }
  return left_out;
}

}  // namespace orrery::particles
