// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <fmt/core.h>

#include "base/error.h"
#include "base/text.h"
#include "points/sources.h"

namespace orrery::points {
namespace {

/// A scene::NumberArray stores these as floats.
bool fits_single(data::ColumnType type) {
  return type == data::ColumnType::kFloat32 || data::bytes_per_value(type) < 4;
}

}  // namespace

data::ColumnType type_of(const data::FrameInfo& info, const std::string& column) {
  const data::ColumnInfo* const known = data::find_named(info.columns, column);
  return known != nullptr ? known->type : data::ColumnType::kFloat64;
}

std::uint64_t bytes_per_sphere(const data::FrameInfo& info, const scene::PointsKeys& points, const RadiusSource& radius,
                               bool are_rounded) {
  bool all_single = points.assembly.empty() && points.transform == scene::PointsTransform{} && !points.unwrap &&
                    points.replicate == math::Vec3d{1, 1, 1};
  for (const std::string& column : info.roles.position) all_single = all_single && fits_single(type_of(info, column));
  std::uint64_t bytes = 3 * (are_rounded || all_single ? sizeof(float) : sizeof(double));
  const bool same = radius.scale == 1 && points.transform.scale == 1;
  if (radius.kind != RadiusSource::Kind::kValue)
    bytes += same && fits_single(type_of(info, radius.column)) ? sizeof(float) : sizeof(double);
  return bytes;
}

void require_memory(const std::filesystem::path& file, std::uint64_t rows, double spheres, double bytes,
                    std::uint64_t limit) {
  if (limit == 0 || bytes <= static_cast<double>(limit)) return;
  const auto whole = [](double x) { return static_cast<std::uint64_t>(std::min(x, 1e18)); };
  throw base::Error(
      base::ErrorKind::kNoMemory,
      fmt::format("{}: {} rows{} need {} while they are read; {} are available; select fewer rows, or "
                  "render on a machine with more memory",
                  file.string(), rows, spheres > 0 ? " and " + std::to_string(whole(spheres)) + " spheres" : "",
                  base::bytes_text(whole(bytes)), base::bytes_text(limit)));
}

}  // namespace orrery::points
