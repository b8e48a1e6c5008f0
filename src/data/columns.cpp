// SPDX-License-Identifier: Apache-2.0
#include "data/columns.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <utility>

#include <fmt/core.h>

#include "base/text.h"
#include "data/text_lines.h"

namespace orrery::data {

namespace {

/// Returns the column with one of the names, of which earlier ones have priority; null if there is none.
const ColumnInfo* find_suitable(const std::vector<ColumnInfo>& columns, std::initializer_list<const char*> names,
                                bool (*is_suitable)(const ColumnInfo&)) {
  for (const char* name : names)
    for (const ColumnInfo& column : columns)
      if (base::lower(column.name) == name && is_suitable(column)) return &column;
  return nullptr;
}

/// Whether an array of three components with this name contains positions.
bool is_position_name(std::string_view name) {
  return base::contains({"pos", "position", "positions", "coords", "coordinates", "points", "xyz"}, base::lower(name));
}

double full_intensity(ColumnType type) {
  const bool is_float = type == ColumnType::kFloat64 || type == ColumnType::kFloat32;
  return is_float ? 1 : type == ColumnType::kUint16 ? 65535 : 255;
}

}  // namespace

Roles customary_roles(const std::vector<ColumnInfo>& columns) {
  const auto is_any = [](const ColumnInfo&) { return true; };
  const auto is_text = [](const ColumnInfo& column) { return column.type == ColumnType::kText; };
  Roles roles;
  roles.position = number_columns(columns, {{"x", "y", "z"},
                                            {"pos_x", "pos_y", "pos_z"},
                                            {"position_x", "position_y", "position_z"},
                                            {"points:0", "points:1", "points:2"},
                                            {"points_0", "points_1", "points_2"},
                                            {"xu", "yu", "zu"},    // unwrapped ones of LAMMPS
                                            {"x0", "y0", "z0"}});  // the first ends of segments
  roles.radius = number_column(columns, {"radius", "scalar_radius"});
  const bool r_is_color =
      find_suitable(columns, {"g"}, is_any) != nullptr && find_suitable(columns, {"b"}, is_any) != nullptr;
  if (roles.radius.empty() && !r_is_color) roles.radius = number_column(columns, {"r"});
  if (roles.radius.empty()) {
    roles.radius = number_column(columns, {"diameter"});
    if (!roles.radius.empty()) roles.radius_scale = 0.5;
  }
  if (const ColumnInfo* const element = find_suitable(columns, {"element", "species", "symbol"}, is_text))
    roles.element = element->name;
  if (const ColumnInfo* const type = find_suitable(columns, {"type", "class", "classification"}, is_any))
    roles.type = type->name;
  if (const ColumnInfo* const chain = find_suitable(columns, {"subchain", "chain"}, is_text)) roles.chain = chain->name;
  roles.id = number_column(columns, {"id"});
  roles.rgb = number_columns(columns, {{"red", "green", "blue"},
                                       {"r", "g", "b"},
                                       {"diffuse_red", "diffuse_green", "diffuse_blue"},
                                       {"rgb[1]", "rgb[2]", "rgb[3]"},
                                       {"rgba[1]", "rgba[2]", "rgba[3]"},
                                       {"color[1]", "color[2]", "color[3]"},
                                       {"colors[1]", "colors[2]", "colors[3]"},
                                       {"colour[1]", "colour[2]", "colour[3]"},
                                       {"colours[1]", "colours[2]", "colours[3]"}});
  if (const ColumnInfo* const red = find_named(columns, roles.rgb[0]); red != nullptr && !roles.rgb[0].empty())
    roles.rgb_maximum = full_intensity(red->type);
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
  const ColumnInfo* const found =
      find_suitable(columns, names, [](const ColumnInfo& column) { return column.type != ColumnType::kText; });
  return found != nullptr ? found->name : "";
}

std::array<std::string, 3> number_columns(const std::vector<ColumnInfo>& columns,
                                          std::initializer_list<std::array<const char*, 3>> triples) {
  for (const auto& [x, y, z] : triples) {
    std::array<std::string, 3> out = {number_column(columns, {x}), number_column(columns, {y}),
                                      number_column(columns, {z})};
    if (std::find(out.begin(), out.end(), "") == out.end()) return out;
  }
  return {};
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

std::vector<std::string> with_sources(const std::vector<std::string>& names, const std::array<std::string, 3>& computed,
                                      const std::array<std::string, 3>& sources) {
  std::vector<std::string> out = names;
  const auto is_computed = [&](const std::string& name) {
    return std::count(computed.begin(), computed.end(), name) > 0;
  };
  if (std::erase_if(out, is_computed) == 0) return out;
  for (const std::string& source : sources)
    if (!base::contains(out, source)) out.push_back(source);
  return out;
}

std::vector<double> unscaled(const Table& table, const std::array<std::string, 3>& columns, const Box& box,
                             std::size_t axis) {
  std::array<const double*, 3> scaled{};
  for (std::size_t i = 0; i < 3; ++i) scaled[i] = std::get<std::vector<double>>(table.find(columns[i])->values).data();
  const auto part = [axis](const Vec3d& v) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; };
  const double origin = part(box.origin);
  const double a = part(box.edges[0]);
  const double b = part(box.edges[1]);
  const double c = part(box.edges[2]);
  std::vector<double> out(table.rows);
  constexpr std::size_t kGrain = std::size_t{1} << 16;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, table.rows, kGrain), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i)
      out[i] = origin + scaled[0][i] * a + scaled[1][i] * b + scaled[2][i] * c;
  });
  return out;
}

Table copied_columns(const Table& table, const std::vector<std::string>& names) {
  Table out{table.rows, {}};
  for (const std::string& name : names) out.columns.push_back(*table.find(name));
  return out;
}

Table in_order(Table table, const std::vector<std::string>& names) {
  Table out;
  out.rows = table.rows;
  for (const std::string& name : names) out.columns.push_back(std::move(*table.find(name)));
  return out;
}

std::string listed(const std::vector<ColumnInfo>& columns) {
  constexpr std::size_t kMaxListed = 30;
  std::string out;
  for (std::size_t i = 0; i < std::min(columns.size(), kMaxListed); ++i) out += (i > 0 ? ", " : "") + columns[i].name;
  if (columns.size() > kMaxListed) out += fmt::format(", ... ({} in all)", columns.size());
  return out;
}

}  // namespace orrery::data
