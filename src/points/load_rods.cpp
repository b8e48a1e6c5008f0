// SPDX-License-Identifier: Apache-2.0
#include "points/load_rods.h"

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include <fmt/core.h>

#include "data/columns.h"
#include "data/data_file.h"
#include "formats/open.h"
#include "points/read_memory.h"
#include "points/rows.h"
#include "scene/limits.h"
#include "scene/scene.h"

namespace orrery::points {
namespace {

constexpr const char* kFromColumns[] = {"x0", "y0", "z0"};
constexpr const char* kToColumns[] = {"x1", "y1", "z1"};
constexpr const char* kRadiusColumn = "radius";

/// Sets points from three columns.
scene::PointArray points_of(const data::Table& table, const char* const (&columns)[3]) {
  scene::PointArray out(table.rows);
  for (std::size_t axis = 0; axis < 3; ++axis)
    for_each_number(*table.find(columns[axis]), Rows(table.rows),
                    [&](std::size_t i, double v) { out.set(i, axis, v); });
  return out;
}

}  // namespace

std::vector<scene::SceneDiagnostic> load_rods(const LoadRequest& request, scene::RodFile& rods) {
  rods.release_rods();
  KeyFaults faults(request.key);
  data::OpenOptions options;
  options.limit_memory(request.memory_limit);
  const std::unique_ptr<data::DataFile> file = formats::open(request.file, options);
  const data::FrameInfo info = file->describe(0);
  std::vector<std::string> columns(kFromColumns, kFromColumns + 3);
  columns.insert(columns.end(), kToColumns, kToColumns + 3);
  if (!rods.radius) columns.emplace_back(kRadiusColumn);
  for (const std::string& name : columns) {
    const data::ColumnInfo* const column = data::find_named(info.columns, name);
    const bool is_radius = name == kRadiusColumn;
    if (column == nullptr)
      faults.error(is_radius ? "" : ".file",
                   is_radius ? fmt::format("{} has no column `radius`; set `radius`", rods.file.string())
                             : fmt::format("{} has no column `{}`; rods need x0, y0, z0, x1, y1 and z1",
                                           rods.file.string(), name));
    else if (column->type == data::ColumnType::kText)
      faults.error(".file", fmt::format("column `{}` of {} is text; rods need numbers", name, rods.file.string()));
  }
  if (info.rows > scene::kMaxSpheres / 2)
    faults.error(".file", fmt::format("has {} rows; the maximum is {}", info.rows, scene::kMaxSpheres / 2));
  if (faults.has_errors()) return faults.take();

  ReadMemory need;
  need.file_bytes = file->memory();
  need.rows = info.rows;
  for (const std::string& column : columns) need.row_bytes += data::bytes_per_value(type_of(info, column));
  need.sphere_bytes = need.row_bytes;
  need.spheres = static_cast<double>(info.rows);
  require_memory(need, request.memory_limit, request.file);
  const data::Table table = file->read(0, columns);
  if (table.rows == 0) faults.warning(".file", "has no rows");
  rods.from = points_of(table, kFromColumns);
  rods.to = points_of(table, kToColumns);
  rods.radii = scene::NumberArray(table.rows, rods.radius.value_or(0));
  if (!rods.radius)
    for_each_number(*table.find(kRadiusColumn), Rows(table.rows),
                    [&](std::size_t i, double v) { rods.radii.set(i, v); });
  return faults.take();
}

}  // namespace orrery::points
