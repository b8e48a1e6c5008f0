// SPDX-License-Identifier: Apache-2.0
// Accelerators with which tests and benchmarks compare Embree; the list of the book is accel::make_list.
#pragma once

#include <memory>

#include "accel/accel.h"

namespace orrery::accel {

/// The naive list with one ray per lane: the baseline that a BVH has to beat.
///
/// Domain     the view's spheres outlive the result; precision is exact or fast
std::unique_ptr<Accel> make_simd_list(const kernel::SceneView& scene, kernel::Precision precision);

/// Embree's built-in sphere points, traced one ray at a time in float, as in a renderer without its own intersection.
/// Traces float packets only. Hits are Embree's, not the kernel's, so no image is rendered with them.
///
/// Domain     at least one sphere; coordinates representable as float
/// Errors     base::Error: kNoMemory, kInternal if Embree fails
std::unique_ptr<Accel> make_native_points(const kernel::SceneView& scene);

}  // namespace orrery::accel
