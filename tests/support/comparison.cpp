// SPDX-License-Identifier: Apache-2.0
#include "support/comparison.h"

#include <memory>
#include <numeric>
#include <vector>

#include "accel/accel.h"
#include "accel/embree_scene.h"
#include "accel/sphere_classes.h"
#include "kernel/ray_packet.h"
#include "kernel/scene_view.h"
#include "support/sphere_points.h"

namespace orrery::accel {
namespace {

/// Treats every sphere as an outlier, without a BVH. Rods are those of a list.
class SimdList final : public Accel {
 public:
  SimdList(const kernel::SceneView& view, kernel::Precision precision)
      : functions_(embree_functions(precision)), is_fast_(precision == kernel::Precision::kFast) {
    scene_.view = view;
    scene_.outliers = ordinary_spheres(view, {});
    if (view.rods.empty()) return;
    std::vector<std::uint32_t> not_listed(view.sphere_count);
    std::iota(not_listed.begin(), not_listed.end(), 0u);
    for (const std::uint32_t object : view.duplicates)
      if (object >= view.sphere_count) not_listed.push_back(object);
    kernel::SceneView rods = view;
    rods.duplicates = not_listed;
    rods_ = make_list(rods, precision);
  }

  kernel::Tracer tracer(std::optional<Traversal>) const noexcept override {
    kernel::Tracer t = functions_.tracer_of(traced_);
    if (!rods_) return t;
    t.trace = is_fast_ ? query<kernel::RayPacket<float>> : query<kernel::RayPacket<double>>;
    t.occlude = is_fast_ ? query<kernel::ShadowPacket<float>> : query<kernel::ShadowPacket<double>>;
    t.self = this;
    return t;
  }
  void set_opacity(const float* opacity) noexcept override {
    scene_.view.opacity = opacity;
    if (rods_) rods_->set_opacity(opacity);
  }
  std::string name() const override { return "SIMD list"; }
  std::size_t bytes() const noexcept override { return scene_.outliers.size() * sizeof(scene_.outliers[0]); }

 private:
  /// A query of the spheres, then of the rods.
  template <class Packet>
  static void query(const void* self, void* packets, int count) {
    const auto& list = *static_cast<const SimdList*>(self);
    const kernel::Tracer spheres = list.functions_.tracer_of(list.traced_), rods = list.rods_->tracer();
    (Packet::kIsShadow ? spheres.occlude : spheres.trace)(spheres.self, packets, count);
    for (int i = 0; i < count; ++i) {
      Packet& packet = static_cast<Packet*>(packets)[i];
      Packet copy = packet;
      (Packet::kIsShadow ? rods.occlude : rods.trace)(rods.self, &copy, 1);
      if constexpr (Packet::kIsShadow)
        for (int lane = 0; lane < packet.count; ++lane) packet.occluded[lane] |= copy.occluded[lane];
      else
        packet = copy;
    }
  }

  EmbreeFunctions functions_;
  EmbreeScene scene_;
  TracedScene traced_{&scene_, {}};
  std::unique_ptr<Accel> rods_;  ///< null: there are none
  bool is_fast_;
};

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

void trace_points(const void* self, kernel::RayPacket<float>& packet) {
  const auto scene = static_cast<RTCScene>(const_cast<void*>(self));
  EmbreeContext context;
  init(context);
  for (int i = 0; i < packet.count; ++i) {
    RTCRayHit ray{};
    ray.ray = one_ray(packet, i);
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query(scene, context, ray);
    if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) continue;
    packet.distance[i] = ray.ray.tfar;
    packet.hit[i] = ray.hit.primID;
  }
}

/// Ignores `target`: without an id test, the maximum distance must exclude the light.
void occlude_points(const void* self, kernel::ShadowPacket<float>& packet) {
  const auto scene = static_cast<RTCScene>(const_cast<void*>(self));
  EmbreeContext context;
  init(context);
  for (int i = 0; i < packet.count; ++i) {
    RTCRay ray = one_ray(packet, i);
    query(scene, context, ray);
    packet.occluded[i] = ray.tfar < 0 ? ~0u : 0;
  }
}

class NativePoints final : public Accel {
 public:
  explicit NativePoints(const kernel::SceneView& view) {
    build_sphere_points(scene_, view.sphere_count, [&](std::size_t i) { return view.spheres[i]; });
  }

  kernel::Tracer tracer(std::optional<Traversal>) const noexcept override {
    kernel::Tracer t;
    t.trace = kernel::query_each<kernel::RayPacket<float>, trace_points>;
    t.occlude = kernel::query_each<kernel::ShadowPacket<float>, occlude_points>;
    t.self = scene_.get();
    return t;
  }
  void set_opacity(const float*) noexcept override {}  // all of its points are opaque
  std::string name() const override { return "embree " + scene_.version() + ", sphere points"; }
  std::size_t bytes() const noexcept override { return scene_.bytes(); }

 private:
  OwnedScene scene_;
};

}  // namespace

std::unique_ptr<Accel> make_simd_list(const kernel::SceneView& scene, kernel::Precision precision) {
  return std::make_unique<SimdList>(scene, precision);
}

std::unique_ptr<Accel> make_native_points(const kernel::SceneView& scene) {
  return std::make_unique<NativePoints>(scene);
}

}  // namespace orrery::accel
