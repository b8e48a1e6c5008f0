// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/vec3.h"

/// The final program of *Ray Tracing in One Weekend*, implemented as fairly as possible: double precision, one ray at a
/// time, virtual calls over a flat list. It is the baseline of orrery's benchmarks; nothing else links it.
///
/// It keeps the book's structure and formulas, but omits costs that are not inherent in the design: shared pointers
/// copied in the loop, hit records copied twice, a slow random number generator.
namespace orrery::bench::baseline {

using math::Vec3d;

class Material;

struct Ray {
  Vec3d origin;
  Vec3d direction;  ///< any length

  Vec3d at(double t) const { return origin + t * direction; }
};

/// An open interval of ray parameters t, in multiples of the direction's length.
struct Interval {
  double min = 0, max = 0;

  bool surrounds(double t) const { return min < t && t < max; }
};

struct HitRecord {
  Vec3d point;
  Vec3d normal;  ///< unit length, facing against the ray
  const Material* material = nullptr;
  double t = 0;
  bool front_face = true;
};

/// Anything that a ray can hit.
class Hittable {
 public:
  virtual ~Hittable() = default;

  /// Result     true if there is a hit within the interval; `record` is written only then
  virtual bool hit(const Ray& ray, Interval t, HitRecord& record) const = 0;
};

}  // namespace orrery::bench::baseline
