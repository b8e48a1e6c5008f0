// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "accel/accel.h"
#include "accel/embree_compat.h"
#include "accel/owned_scene.h"
#include "kernel/ray_packet.h"
#include "kernel/scene_view.h"

namespace orrery::accel {
namespace {

/// Minimum hit distance, as a multiple of the direction's length: without root exclusion a ray would hit the sphere
/// that it leaves.
constexpr float kShortestDistance = 0.001F;

/// Converts a ray of a packet to an Embree ray.
template <class Packet>
RTCRay one_ray(const Packet& packet, int lane) {
  RTCRay ray{};
  ray.org_x = packet.origin[0][lane];
  ray.org_y = packet.origin[1][lane];
  ray.org_z = packet.origin[2][lane];
  ray.dir_x = packet.direction[0][lane];
  ray.dir_y = packet.direction[1][lane];
  ray.dir_z = packet.direction[2][lane];
  ray.tnear = kShortestDistance;
  ray.tfar = packet.distance[lane];
  ray.mask = ~0u;
  return ray;
}

void trace_points(const void* self, kernel::RayPacketFast& packet) {
  const auto scene = static_cast<RTCScene>(const_cast<void*>(self));
  EmbreeContext context;
  init(context);
  for (int i = 0; i < packet.count; ++i) {
    RTCRayHit query{};
    query.ray = one_ray(packet, i);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    intersect(scene, context, query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) continue;
    packet.distance[i] = query.ray.tfar;
    packet.hit[i] = query.hit.primID;
  }
}

/// Ignores `target`: without an id test, the maximum distance must exclude the light.
void occlude_points(const void* self, kernel::ShadowPacketFast& packet) {
  const auto scene = static_cast<RTCScene>(const_cast<void*>(self));
  EmbreeContext context;
  init(context);
  for (int i = 0; i < packet.count; ++i) {
    RTCRay ray = one_ray(packet, i);
    occluded(scene, context, ray);
    packet.occluded[i] = ray.tfar < 0 ? ~0u : 0;
  }
}

class NativePoints final : public Accel {
 public:
  explicit NativePoints(const kernel::SceneView& view) {
    build_sphere_points(scene_, view.sphere_count, [&](std::size_t i) { return view.spheres[i]; });
  }

  kernel::Tracer tracer() const noexcept override {
    kernel::Tracer t;
    t.trace_fast = trace_points;
    t.occlude_fast = occlude_points;
    t.self = scene_.get();
    return t;
  }
  std::string name() const override { return "embree " + scene_.version() + ", sphere points"; }
  std::size_t bytes() const noexcept override { return scene_.bytes(); }

 private:
  OwnedScene scene_;
};

}  // namespace

std::unique_ptr<Accel> make_native_points(const kernel::SceneView& scene) {
  return std::make_unique<NativePoints>(scene);
}

}  // namespace orrery::accel
