// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

namespace orrery::math {

/// A point, direction or colour in double precision. SIMD code reads it through set3().
struct Vec3d {
  double x = 0, y = 0, z = 0;

  friend constexpr bool operator==(const Vec3d&, const Vec3d&) = default;
  friend constexpr Vec3d operator+(Vec3d a, Vec3d b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend constexpr Vec3d operator-(Vec3d a, Vec3d b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend constexpr Vec3d operator-(Vec3d a) { return {-a.x, -a.y, -a.z}; }
  friend constexpr Vec3d operator*(Vec3d a, double s) { return {a.x * s, a.y * s, a.z * s}; }
  friend constexpr Vec3d operator*(double s, Vec3d a) { return a * s; }
  friend constexpr Vec3d operator*(Vec3d a, Vec3d b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
  friend constexpr Vec3d operator/(Vec3d a, double s) { return {a.x / s, a.y / s, a.z / s}; }
};

/// Writes a vector to an array of kernel data.
constexpr void set(double (&to)[3], Vec3d from) {
  to[0] = from.x;
  to[1] = from.y;
  to[2] = from.z;
}

/// A vector from an array of kernel data.
constexpr Vec3d vector_of(const double (&v)[3]) { return {v[0], v[1], v[2]}; }

constexpr double dot(Vec3d a, Vec3d b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
constexpr Vec3d cross(Vec3d a, Vec3d b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
/// The smaller of each pair of components, as std::min returns it: a's, if they are equal or one is not a number.
constexpr Vec3d least(Vec3d a, Vec3d b) { return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)}; }
/// The larger of each pair of components, as std::max returns it: a's, if they are equal or one is not a number.
constexpr Vec3d greatest(Vec3d a, Vec3d b) { return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)}; }
inline double length(Vec3d a) { return std::sqrt(dot(a, a)); }
inline Vec3d normalized(Vec3d a) { return a / length(a); }
inline bool is_finite(Vec3d a) { return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z); }

}  // namespace orrery::math
