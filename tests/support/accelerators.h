// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>

#include "accel/accel.h"
#include "kernel/scene_view.h"
#include "support/comparison.h"

namespace orrery::test {

/// An accelerator and traversal whose hits must agree with those of all others.
struct Way {
  const char* name;
  std::unique_ptr<accel::Accel> (*make)(const kernel::SceneView&, kernel::Precision);
  accel::Traversal traversal;
};

inline std::unique_ptr<accel::Accel> make_boxes(const kernel::SceneView& view, kernel::Precision precision) {
  return accel::make_embree(view, precision);
}
/// The BVH for many spheres, from one sphere on.
inline std::unique_ptr<accel::Accel> make_sphere_bvh(const kernel::SceneView& view, kernel::Precision precision) {
  return accel::make_embree(view, precision, {}, 1);
}

inline constexpr Way kWays[] = {{"packet", make_boxes, accel::Traversal::kPacket},
                                {"single", make_boxes, accel::Traversal::kSingle},
                                {"sphere BVH, packet", make_sphere_bvh, accel::Traversal::kPacket},
                                {"sphere BVH, single", make_sphere_bvh, accel::Traversal::kSingle},
                                {"SIMD list", accel::make_simd_list, accel::Traversal::kPacket},
                                {"list", accel::make_list, accel::Traversal::kPacket}};
/// All but the list, with which they are compared.
inline constexpr std::span kWaysBesideTheList = std::span(kWays).first<std::size(kWays) - 1>();

}  // namespace orrery::test
