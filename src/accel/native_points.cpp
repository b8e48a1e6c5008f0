// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "accel/accel.h"
#include "accel/embree_compat.h"
#include "accel/owned_scene.h"

namespace orrery::accel {
namespace {

/// Starts nearer than this do not count, lengths of the direction: without root exclusion a ray meets the sphere it
/// left.
constexpr float kShortestDistance = 0.001F;

void trace_points(const void* self, kernel::RayPacketFast& packet) {
  const auto scene = static_cast<RTCScene>(const_cast<void*>(self));
  EmbreeContext context;
  init(context);
  for (int i = 0; i < packet.count; ++i) {
    RTCRayHit query{};
    query.ray.org_x = packet.origin[0][i];
    query.ray.org_y = packet.origin[1][i];
    query.ray.org_z = packet.origin[2][i];
    query.ray.dir_x = packet.direction[0][i];
    query.ray.dir_y = packet.direction[1][i];
    query.ray.dir_z = packet.direction[2][i];
    query.ray.tnear = kShortestDistance;
    query.ray.tfar = packet.distance[i];
    query.ray.mask = ~0u;
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    intersect(scene, context, query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) continue;
    packet.distance[i] = query.ray.tfar;
    packet.hit[i] = query.hit.primID;
  }
}

class NativePoints final : public Accel {
 public:
  explicit NativePoints(const kernel::SceneView& view) {
    build_sphere_points(scene_, view.sphere_count, [&](std::size_t i) { return view.spheres[i]; });
  }

  kernel::Tracer tracer() const noexcept override { return {nullptr, trace_points, scene_.get()}; }
  std::string name() const override { return "embree " + embree_version() + ", sphere points"; }
  std::size_t bytes() const noexcept override { return scene_.bytes(); }

 private:
  OwnedScene scene_;
};

}  // namespace

std::unique_ptr<Accel> make_native_points(const kernel::SceneView& scene) {
  return std::make_unique<NativePoints>(scene);
}

}  // namespace orrery::accel
