// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <memory>
#include <string>

#include <fmt/core.h>

#include "data/data_file.h"
#include "points/load_points.h"
#include "points/rows.h"
#include "points/sources.h"
#include "scene/limits.h"

namespace orrery::points {
namespace {

const std::array<std::string, 3> kFromColumns = {"x0", "y0", "z0"}, kToColumns = {"x1", "y1", "z1"};
constexpr const char* kRadiusColumn = "radius";

}  // namespace

std::vector<scene::SceneDiagnostic> load_rods(const LoadRequest& request, scene::RodFile& rods) {
  rods.release_rods();
  KeyFaults faults(request.key);
  data::OpenOptions options;
  options.limit_memory(request.memory_limit);
  const std::unique_ptr<data::DataFile> file = data::open(request.file, options);
  const data::FrameInfo info = file->describe(0);
  std::vector<std::string> columns(kFromColumns.begin(), kFromColumns.end());
  columns.insert(columns.end(), kToColumns.begin(), kToColumns.end());
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

  std::uint64_t row_bytes = 0;  // of the columns, and of the rods
  for (const std::string& column : columns) row_bytes += 2 * data::bytes_per_value(type_of(info, column));
  require_memory(request.file, info.rows, static_cast<double>(info.rows),
                 static_cast<double>(file->memory() + info.rows * row_bytes), request.memory_limit);
  const data::Table table = file->read(0, columns);
  if (table.rows == 0) faults.warning(".file", "has no rows");
  rods.from = points_of(table, Rows(table.rows), kFromColumns);
  rods.to = points_of(table, Rows(table.rows), kToColumns);
  rods.radii = scene::NumberArray(table.rows, rods.radius.value_or(0));
  if (!rods.radius)
    for_each_number(*table.find(kRadiusColumn), Rows(table.rows),
                    [&](std::size_t i, double v) { rods.radii.set(i, v); });
  return faults.take();
}

}  // namespace orrery::points
