// SPDX-License-Identifier: Apache-2.0
#include "points/periodic.h"

#include <algorithm>
#include <cmath>
#include <variant>

namespace orrery::points {
namespace {

/// Writers round coordinates: a point on a face of the box may be slightly outside. In edges of the box.
constexpr double kFaceTolerance = 1e-9;

/// The gradient of the fraction along an edge: dot(gradient, p - origin) is the fraction.
std::array<Vec3d, 3> gradients(const data::Box& box) {
  const auto& [a, b, c] = box.edges;
  const double volume = dot(a, cross(b, c));
  return {cross(b, c) / volume, cross(c, a) / volume, cross(a, b) / volume};
}

}  // namespace

void unwrap(std::span<Vec3d> centers, const data::Box& box, const std::array<const data::Column*, 3>& images) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (images[axis] == nullptr) continue;
    std::visit(
        [&](const auto& values) {
          if constexpr (!requires { values.index; })
            for (std::size_t i = 0; i < centers.size(); ++i)
              centers[i] = centers[i] + static_cast<double>(values[i]) * box.edges[axis];
        },
        images[axis]->values);
  }
}

std::size_t count_outside(std::span<const Vec3d> centers, const data::Box& box) {
  const std::array<Vec3d, 3> gradient = gradients(box);
  std::size_t count = 0;
  for (const Vec3d& p : centers) {
    bool is_outside = false;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double fraction = dot(gradient[axis], p - box.origin);
      if (box.periodic[axis] && (fraction < -kFaceTolerance || fraction > 1 + kFaceTolerance)) is_outside = true;
    }
    count += is_outside ? 1 : 0;
  }
  return count;
}

std::vector<Vec3d> replica_translations(const data::Box& box, const std::array<int, 3>& counts) {
  std::vector<Vec3d> out;
  for (int k = 0; k < counts[2]; ++k)
    for (int j = 0; j < counts[1]; ++j)
      for (int i = 0; i < counts[0]; ++i) out.push_back(i * box.edges[0] + j * box.edges[1] + k * box.edges[2]);
  return out;
}

Vec3d transformed(const data::Transform& transform, Vec3d p) {
  return Vec3d{dot(transform.rows[0], p), dot(transform.rows[1], p), dot(transform.rows[2], p)} + transform.translation;
}

std::vector<std::uint8_t> rows_of_part(const data::AssemblyPart& part, const data::Column* chain, std::size_t rows) {
  if (part.chains.empty()) return std::vector<std::uint8_t>(rows, 1);
  const data::Words& names = std::get<data::Words>(chain->values);
  std::vector<std::uint8_t> is_wanted(names.words.size());
  for (std::size_t i = 0; i < is_wanted.size(); ++i)
    is_wanted[i] = std::find(part.chains.begin(), part.chains.end(), names.words[i]) != part.chains.end();
  std::vector<std::uint8_t> out(rows);
  for (std::size_t i = 0; i < rows; ++i) out[i] = is_wanted[names.index[i]];
  return out;
}

}  // namespace orrery::points
