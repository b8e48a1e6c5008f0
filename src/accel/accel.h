// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "accel/traversal.h"
#include "kernel/precision.h"
#include "kernel/ray_packet.h"
#include "kernel/scene_view.h"

namespace orrery::accel {

/// Finds the nearest hit of rays among a scene's spheres.
///
/// All ways of finding it give the same hits: nearest distance by the kernel's own arithmetic, then smaller id.
class Accel {
 public:
  virtual ~Accel() = default;

  /// What the kernel calls for each packet; valid as long as this Accel lives.
  virtual kernel::Tracer tracer() const noexcept = 0;

  /// Goes on this way from now on; not while rays are traced. A list has but one way.
  virtual void use(Traversals) noexcept {}

  /// "embree 3.13.5", "list".
  virtual std::string name() const = 0;

  /// Bytes that were allocated for it, as far as they are known.
  virtual std::size_t bytes() const noexcept = 0;
};

/// The naive traversal: one ray after the other against one sphere after the other, one lane. For comparison.
///
/// Domain     the view's spheres outlive the result
std::unique_ptr<Accel> make_list(const kernel::SceneView& scene, kernel::Precision precision);

/// The naive traversal with a ray in each lane: what the hierarchy has to beat. For comparison.
///
/// Domain     the view's spheres outlive the result
std::unique_ptr<Accel> make_simd_list(const kernel::SceneView& scene, kernel::Precision precision);

/// Hears how far a build is, 0..1, from any of its threads, and says whether to go on.
using BuildMonitor = std::function<bool(double fraction)>;

/// Spheres as Embree user geometry.
///
/// Domain     the view's spheres outlive the result
/// Errors     base::Error(kInternal) where Embree fails or would drop a sphere, kStopped where the monitor said so
std::unique_ptr<Accel> make_embree(const kernel::SceneView& scene, kernel::Precision precision,
                                   const BuildMonitor& monitor = {});

/// Embree's own sphere points, one ray at a time, in float, as a renderer has them that writes no intersection of its
/// own. Only rays of the fast kernel can be traced; hits are Embree's, not ours, so no picture is made of them. For
/// comparison.
///
/// Domain     1 sphere or more, which fit into floats
/// Errors     base::Error(kInternal) where Embree fails
std::unique_ptr<Accel> make_native_points(const kernel::SceneView& scene);

/// The version of Embree that is loaded, "3.13.5".
std::string embree_version();

}  // namespace orrery::accel
