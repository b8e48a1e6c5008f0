// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace orrery::test {

/// A 3D vector over a number type with arithmetic operators.
template <class Real>
struct Vec3Of {
  Real x, y, z;
  friend Vec3Of operator+(const Vec3Of& a, const Vec3Of& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Vec3Of operator-(const Vec3Of& a, const Vec3Of& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Vec3Of operator*(const Vec3Of& a, const Real& s) { return {a.x * s, a.y * s, a.z * s}; }
  friend Real dot(const Vec3Of& a, const Vec3Of& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
};

}  // namespace orrery::test
