// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "accel/traversal.h"
#include "kernel/forward.h"
#include "kernel/precision.h"
#include "kernel/ray_packet.h"

namespace orrery::accel {

/// Answers closest-hit and occlusion queries against a scene's spheres and rods.
///
/// All implementations give the same results: the closest hit has the smallest distance as the kernel's arithmetic
/// computes it, then the smallest id; occlusion uses the same intersections.
class Accel {
 public:
  virtual ~Accel() = default;

  /// The queries that the kernel calls; valid during the lifetime of this Accel.
  ///
  /// `requested`  traversal of all rays; empty: the fastest for each kind of rays. Lists have only one
  virtual kernel::Tracer tracer(std::optional<Traversal> requested) const noexcept = 0;
  kernel::Tracer tracer() const noexcept { return tracer(std::nullopt); }

  /// Replaces kernel::SceneView::opacity of the scene, without a new build.
  ///
  /// Domain     no query is under way; the array outlives its use
  virtual void set_opacity(const float* opacity) noexcept = 0;

  /// For example "embree 3.13.5" or "list".
  virtual std::string name() const = 0;

  /// The traversals of tracer(), as name_of() formats them, or "list".
  virtual std::string traversal_name(std::optional<Traversal>) const { return "list"; }

  /// Allocated bytes, where known.
  virtual std::size_t bytes() const noexcept = 0;
};

/// Receives the progress of a build, 0..1, on any of its threads. Returns false to cancel the build.
using BuildMonitor = std::function<bool(double fraction)>;

/// Minimum number of static spheres and rods of similar size for a SphereBvh: they then form a single primitive of
/// Embree's scene (docs/decisions/0027-bvh-for-many-spheres.md). With fewer, each sphere is a primitive, which is
/// faster. Depends on the instruction set.
std::size_t bvh_threshold();

/// A threshold that no scene reaches.
inline constexpr std::size_t kNoBvh = ~std::size_t{0};

/// Spheres as Embree user geometry.
///
/// Domain     the view's spheres outlive the result; precision is exact or fast
/// Errors     base::Error: kStopped if the monitor cancelled the build, kNoMemory, kInternal if Embree fails or would
///            drop a sphere
std::unique_ptr<Accel> make_embree(const kernel::SceneView& scene, kernel::Precision precision,
                                   const BuildMonitor& monitor = {}, std::size_t threshold = bvh_threshold());

struct ObjectCounts {
  std::size_t spheres = 0, rods = 0;
  bool have_one_radius = false;  ///< all spheres have the same radius, and there are no rods
  bool move = false;             ///< spheres do

  std::size_t all() const { return spheres + rods; }
};

/// Approximate numbers of spheres and rods that make_embree puts into its BVH of many spheres, where each takes 10 to
/// 13 bytes, and 4 more if there are rods or spheres move, instead of Embree's hundred.
ObjectCounts objects_in_bvh(const kernel::SceneView& scene);

/// Embree's version, for example "3.13.5".
std::string embree_version();

/// The naive list, for comparison: intersects each ray with each sphere in turn, with one lane.
///
/// Domain     the view's spheres outlive the result
std::unique_ptr<Accel> make_list(const kernel::SceneView& scene, kernel::Precision precision);

}  // namespace orrery::accel
