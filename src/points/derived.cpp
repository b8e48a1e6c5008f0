// SPDX-License-Identifier: Apache-2.0
#include "points/derived.h"

#include <array>
#include <cmath>

#include "data/columns.h"
#include "points/rows.h"

namespace orrery::points {
namespace {

/// The file's names of the three components of the velocity; empty if it has none.
std::vector<std::string> velocity_of(const data::FrameInfo& info) {
  const std::array<std::string, 3> names =
      data::number_columns(info.columns, {{"vx", "vy", "vz"},
                                          {"velocity[1]", "velocity[2]", "velocity[3]"},
                                          {"velocities[1]", "velocities[2]", "velocities[3]"},
                                          {"vel[1]", "vel[2]", "vel[3]"},
                                          {"velo[1]", "velo[2]", "velo[3]"}});
  return names[0].empty() ? std::vector<std::string>() : std::vector<std::string>(names.begin(), names.end());
}

}  // namespace

void add_derived_columns(data::FrameInfo& info) {
  if (data::find_named(info.columns, kSpeed) == nullptr && !velocity_of(info).empty())
    info.columns.push_back({kSpeed, data::ColumnType::kFloat64, true});
}

std::vector<std::string> sources_of(const data::FrameInfo& info, const std::string& column) {
  const data::ColumnInfo* const known = data::find_named(info.columns, column);
  return known != nullptr && known->is_derived ? velocity_of(info) : std::vector<std::string>();
}

void compute_speed(const std::vector<std::string>& sources, data::Table& table) {
  std::vector<double> speed(table.rows);
  for (const std::string& name : sources)
    for_each_number(*table.find(name), Rows(table.rows), [&](std::size_t i, double v) { speed[i] += v * v; });
  for (double& s : speed) s = std::sqrt(s);
  table.columns.push_back({kSpeed, std::move(speed)});
}

}  // namespace orrery::points
