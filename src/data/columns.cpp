// SPDX-License-Identifier: Apache-2.0
#include "data/columns.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

#include <fmt/core.h>

#include "base/text.h"
#include "data/faults.h"
#include "data/text_lines.h"

namespace orrery::data {

namespace {

/// ASCII only, whatever the locale is.
char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

bool equals(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) { return lower(x) == lower(y); });
}

using Triple = std::array<const char*, 3>;

/// The columns of a file by name.
class Names {
 public:
  explicit Names(const std::vector<ColumnInfo>& columns) : columns_(columns) {}

  /// Returns the column with one of the names, of which earlier ones have priority; null if there is none.
  const ColumnInfo* find(std::initializer_list<const char*> names) const {
    for (const char* name : names)
      for (const ColumnInfo& column : columns_)
        if (equals(column.name, name)) return &column;
    return nullptr;
  }
  bool is_number(const char* name) const {
    const ColumnInfo* const column = find({name});
    return column != nullptr && column->type != ColumnType::kText;
  }
  std::string number(std::initializer_list<const char*> names) const {
    for (const char* name : names)
      if (is_number(name)) return find({name})->name;
    return {};
  }
  std::array<std::string, 3> numbers(std::initializer_list<Triple> triples) const {
    for (const Triple& t : triples)
      if (is_number(t[0]) && is_number(t[1]) && is_number(t[2]))
        return {number({t[0]}), number({t[1]}), number({t[2]})};
    return {};
  }

 private:
  const std::vector<ColumnInfo>& columns_;
};

double full_intensity(ColumnType type) {
  switch (type) {
    case ColumnType::kFloat64:
    case ColumnType::kFloat32: return 1;
    case ColumnType::kUint16: return 65535;
    case ColumnType::kInt64:
    case ColumnType::kInt32:
    case ColumnType::kUint8:
    case ColumnType::kText: break;
  }
  return 255;
}

}  // namespace

Roles customary_roles(const std::vector<ColumnInfo>& columns) {
  const Names names(columns);
  Roles roles;
  roles.position = names.numbers({{"x", "y", "z"},
                                  {"pos_x", "pos_y", "pos_z"},
                                  {"position_x", "position_y", "position_z"},
                                  {"points:0", "points:1", "points:2"},
                                  {"points_0", "points_1", "points_2"},
                                  {"x0", "y0", "z0"}});  // the first ends of segments
  roles.radius = names.number({"radius", "scalar_radius"});
  const bool r_is_color = names.find({"g"}) != nullptr && names.find({"b"}) != nullptr;
  if (roles.radius.empty() && !r_is_color) roles.radius = names.number({"r"});
  if (roles.radius.empty()) {
    roles.radius = names.number({"diameter"});
    if (!roles.radius.empty()) roles.radius_scale = 0.5;
  }
  for (const char* name : {"element", "species", "symbol"})
    if (const ColumnInfo* const column = names.find({name});
        roles.element.empty() && column != nullptr && column->type == ColumnType::kText)
      roles.element = column->name;
  if (const ColumnInfo* const type = names.find({"type", "class", "classification"})) roles.type = type->name;
  roles.id = names.number({"id"});
  roles.rgb = names.numbers({{"red", "green", "blue"},
                             {"r", "g", "b"},
                             {"diffuse_red", "diffuse_green", "diffuse_blue"},
                             {"rgb[1]", "rgb[2]", "rgb[3]"},
                             {"rgba[1]", "rgba[2]", "rgba[3]"},
                             {"color[1]", "color[2]", "color[3]"},
                             {"colors[1]", "colors[2]", "colors[3]"},
                             {"colour[1]", "colour[2]", "colour[3]"},
                             {"colours[1]", "colours[2]", "colours[3]"}});
  for (const ColumnInfo& column : columns)
    if (!roles.rgb[0].empty() && column.name == roles.rgb[0]) roles.rgb_maximum = full_intensity(column.type);
  return roles;
}

Roles required_roles(const std::vector<ColumnInfo>& columns, Faults& faults) {
  Roles roles = customary_roles(columns);
  if (roles.position[0].empty())
    faults.fail(0, "there are no columns x, y and z of numbers; the columns are: " + listed(columns),
                "name the coordinates x, y and z");
  return roles;
}

std::string number_column(const std::vector<ColumnInfo>& columns, std::initializer_list<const char*> names) {
  return Names(columns).number(names);
}

bool is_position_name(std::string_view name) {
  for (const char* known : {"pos", "position", "positions", "coords", "coordinates", "points", "xyz"})
    if (equals(name, known)) return true;
  return false;
}

std::vector<std::string> component_names(const std::string& name, std::size_t components,
                                         const std::vector<ColumnInfo>& columns) {
  if (components == 1) return {name};
  if (components == 3 && is_position_name(name) && !has_column(columns, "x") && !has_column(columns, "y") &&
      !has_column(columns, "z"))
    return {"x", "y", "z"};
  std::vector<std::string> out;
  for (std::size_t i = 1; i <= components; ++i) out.push_back(fmt::format("{}[{}]", name, i));
  return out;
}

std::string UniqueNames::add(const std::string& name) {
  std::string out = name;
  if (names_.insert(out).second) return out;
  int& number = numbers_[name];
  number = std::max(number, 1);
  do out = fmt::format("{}_{}", name, ++number);
  while (!names_.insert(out).second);
  return out;
}

std::string listed(const std::vector<ColumnInfo>& columns) {
  constexpr std::size_t kMaxListed = 30;
  std::string out;
  for (std::size_t i = 0; i < std::min(columns.size(), kMaxListed); ++i) out += (i > 0 ? ", " : "") + columns[i].name;
  if (columns.size() > kMaxListed) out += fmt::format(", ... ({} in all)", columns.size());
  return out;
}

int atomic_number(std::string_view word) {
  word = trimmed(word);
  const std::string symbol = base::lower(word);
  if (symbol == "d") return 1;
  for (std::size_t i = 0; i < kElementSymbols.size(); ++i)
    if (symbol == base::lower(kElementSymbols[i])) return static_cast<int>(i) + 1;
  constexpr auto kLast = static_cast<int>(kElementSymbols.size());
  int number = 0;
  const auto [end, status] = std::from_chars(word.data(), word.data() + word.size(), number);
  const bool is_number = status == std::errc() && end == word.data() + word.size();
  return is_number && number >= 1 && number <= kLast ? number : 0;
}

void settle_element(const std::vector<std::string>& names, Roles& roles) {
  if (std::all_of(names.begin(), names.end(), [](const std::string& name) { return atomic_number(name) != 0; })) return;
  const std::string column = std::exchange(roles.element, {});
  if (roles.type.empty()) roles.type = column;
}

}  // namespace orrery::data
