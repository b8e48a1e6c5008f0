// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "baseline/hittable.h"

namespace orrery::bench::baseline {

/// A sphere of an authored scene, and what it is made of.
struct PlacedSphere {
  Vec3d center;
  double radius;  ///< scene units; negative: the normal points inward
  const Material* material;
};

/// What somebody writes who swaps the book's list for Embree's own sphere points: one ray at a time, in float.
///
/// Embree is given one thread. Its sphere points know no negative radius and no normal in the book's sense; both come
/// from the sphere. `hit` leaves out what a scalar loop does not need: filters, flags, several geometries.
///
/// Domain     the materials outlive the result
/// Errors     base::Error(kInternal) where Embree fails
std::unique_ptr<const Hittable> make_native_points(std::vector<PlacedSphere> spheres);

}  // namespace orrery::bench::baseline
