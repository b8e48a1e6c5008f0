// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/vec3.h"

/// The program that a reader of *Ray Tracing in One Weekend* has at the end of the book, as fairly as it can be
/// written: double, one ray at a time, virtual calls over a flat list. What orrery is measured against; nothing else
/// links it.
///
/// It keeps the book's structure and formulas, and leaves out what slows that program down for no reason of its design:
/// shared pointers that are copied in the loop, records that are copied twice, a slow random number generator.
namespace orrery::bench::baseline {

using math::Vec3d;

class Material;

struct Ray {
  Vec3d origin;
  Vec3d direction;  ///< any length

  Vec3d at(double t) const { return origin + t * direction; }
};

/// The distances that count, in lengths of the ray's direction, ends left out.
struct Interval {
  double min = 0, max = 0;

  bool surrounds(double t) const { return min < t && t < max; }
};

struct HitRecord {
  Vec3d point;
  Vec3d normal;  ///< unit, against the ray
  const Material* material = nullptr;
  double t = 0;
  bool front_face = true;
};

/// Whatever a ray can meet.
class Hittable {
 public:
  virtual ~Hittable() = default;

  /// Result     whether there is a hit within the interval; only then `record` is written
  virtual bool hit(const Ray& ray, Interval t, HitRecord& record) const = 0;
};

}  // namespace orrery::bench::baseline
