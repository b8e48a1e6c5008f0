// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "baseline/hittable.h"

namespace orrery::bench::baseline {

/// A sphere of the authored scene with its material.
struct PlacedSphere {
  Vec3d center;
  double radius;  ///< scene units; negative: the normal points inward
  const Material* material;
};

/// The book's program with its list replaced by Embree's sphere points: one ray at a time, in single precision.
///
/// Embree uses one thread. Sphere points support neither negative radii nor normals as the book defines them; both are
/// taken from the authored sphere. `hit` omits what a scalar loop does not need: filters, flags, several geometries.
///
/// Domain     the materials outlive the result
/// Errors     base::Error(kInternal) if Embree fails
std::unique_ptr<const Hittable> make_native_points(std::vector<PlacedSphere> spheres);

}  // namespace orrery::bench::baseline
