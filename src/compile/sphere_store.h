// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "kernel/sphere_array.h"

namespace orrery::compile {

/// The spheres of a compiled scene, in 12 bytes each where that loses nothing.
class SphereStore {
 public:
  std::size_t size() const noexcept { return plain_.size() + centers_.size() / 3; }
  bool empty() const noexcept { return size() == 0; }
  kernel::Sphere operator[](std::size_t id) const noexcept { return view()[id]; }

  /// Appends a sphere as it is. Not after spheres that are compact.
  void push_back(const kernel::Sphere& sphere) { plain_.push_back(sphere); }

  /// Appends the last `count` spheres, compact if their centres, and their radii if these differ, are exact in single
  /// precision.
  ///
  /// `at`  returns the sphere with an index below `count`; called in ascending order, up to three times from 0 on
  template <class At>
  void append(std::size_t count, At at) {
    const std::size_t begin = plain_.size();
    bool fits = count > 0, has_radii = false;
    const double radius = count > 0 ? at(0).radius : 0;
    for (std::size_t i = 0; i < count && fits; ++i) {
      const kernel::Sphere s = at(i);
      has_radii = has_radii || s.radius != radius;
      fits = is_single(s.x) && is_single(s.y) && is_single(s.z) &&
             (!has_radii || (is_single(s.radius) && is_single(radius)));
    }
    if (!fits) {
      plain_.reserve(begin + count);
      for (std::size_t i = 0; i < count; ++i) plain_.push_back(at(i));
      return;
    }
    radius_ = radius;
    centers_.resize(3 * count);
    if (has_radii) radii_.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      const kernel::Sphere s = at(i);
      centers_[3 * i] = static_cast<float>(s.x);
      centers_[3 * i + 1] = static_cast<float>(s.y);
      centers_[3 * i + 2] = static_cast<float>(s.z);
      if (has_radii) radii_[i] = static_cast<float>(s.radius);
    }
  }

  /// Valid until this is modified.
  kernel::SphereArray view() const noexcept {
    kernel::SphereArray v(plain_.data());
    if (centers_.empty()) return v;
    v.plain_count = plain_.size();
    v.centers = centers_.data();
    v.radii = radii_.empty() ? nullptr : radii_.data();
    v.radius = radius_;
    return v;
  }

  std::size_t bytes() const noexcept {
    return plain_.size() * sizeof(kernel::Sphere) + (centers_.size() + radii_.size()) * sizeof(float);
  }

 private:
  static bool is_single(double x) { return static_cast<double>(static_cast<float>(x)) == x; }

  std::vector<kernel::Sphere> plain_;
  std::vector<float> centers_, radii_;
  double radius_ = 0;
};

}  // namespace orrery::compile
