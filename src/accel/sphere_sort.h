// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "accel/box_frame.h"
#include "accel/sphere_bvh.h"
#include "accel/sphere_codes.h"
#include "base/stop_point.h"
#include "kernel/sphere.h"

namespace orrery::accel {

/// The spheres of a scene, and the spheres that enclose its rods, by id.
struct EnclosingSpheres {
  BoundedSpheres spheres;
  BoundedRods rods;
  BoxFrame frame;

  /// World space.
  kernel::Sphere operator[](std::uint32_t id) const noexcept {
    return rods.rods.contains(id) ? enclosing_sphere(rods.at(rods.rods.index(id), 0)) : spheres[id];
  }
  /// One coordinate of a centre, box space.
  float coordinate(std::uint32_t id, int axis) const noexcept {
    const auto x = [&] {
      if (!rods.rods.contains(id)) return spheres.coordinate(id, axis);
      const kernel::Sphere s = (*this)[id];
      return axis == 0 ? s.x : axis == 1 ? s.y : s.z;
    };
    return static_cast<float>((x() - frame.middle[axis]) * frame.scale);
  }
  SphereItem item(std::uint32_t id) const noexcept {
    return {{coordinate(id, 0), coordinate(id, 1), coordinate(id, 2)}, id};
  }
};

/// Sorts spheres into the order of the leaves of a BVH, using the surface area heuristic.
///
/// It takes two stages: items in memory are sorted fastest, but take four times the memory of ids. So divide() sorts
/// ids until the spheres below one node are together, and sort() the items of one such part at a time.
class SphereSort {
 public:
  using Monitor = std::function<bool(double)>;

  /// The spheres below one node.
  struct Part {
    std::size_t begin, count;  ///< place in the order of the leaves
    std::size_t unit;          ///< number of spheres below a child of the node, or more
    SphereBvh::Cell cell;
  };

  /// `count`      number of spheres
  /// `part_size`  most spheres in a part: a power of kArity, at least its square
  /// `margin`     average radius, for the surface area, box space
  /// `reach`      maximum distance of a sphere's surface from its centre, padded, box space
  /// `monitor`    receives the progress, 0..1, on any thread; returns false to cancel; or empty
  SphereSort(std::size_t count, std::size_t part_size, float margin, float reach, const Monitor& monitor);

  /// Sorts ids until each part is contiguous.
  ///
  /// Result     the parts, in the order of their spheres
  /// Errors     base::Error(kStopped) if the monitor or a base::StopScope cancelled; those of sort() too
  std::vector<Part> divide(const EnclosingSpheres& spheres, std::span<std::uint32_t> ids);

  /// Sorts the items of a part.
  void sort(const Part& part, std::span<SphereItem> items);

  /// The cells of the nodes by level, starting with the level above the leaves; complete when all parts are sorted.
  const std::vector<SphereBvh::Cell>& cells(std::size_t level) const { return cells_[level]; }

 private:
  template <class Items>
  void divide(const Items& items, std::span<typename Items::Item> range, Part part, std::vector<Part>* parts);
  void report(std::size_t count);
  void throw_if_stopped() const;

  std::size_t count_, part_size_;
  float margin_, reach_;
  const Monitor& monitor_;
  std::array<std::vector<SphereBvh::Cell>, SphereBvh::kMaxDepth> cells_;
  std::atomic<std::size_t> done_{0};
  std::atomic<bool> stopped_{false};
  base::StopPoint stop_;
};

}  // namespace orrery::accel
