// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <memory>

#include "accel/accel.h"
#include "accel/embree_compat.h"
#include "base/error.h"

namespace orrery::accel {
namespace {

void require(bool holds) {
  if (!holds) throw base::Error(base::ErrorKind::kInternal, "Embree cannot build sphere points");
}

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
  explicit NativePoints(const kernel::SceneView& view) : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
    require(scene_ != nullptr);
    rtcSetDeviceMemoryMonitorFunction(
        device_,
        [](void* self, ssize_t bytes, bool) {
          static_cast<NativePoints*>(self)->bytes_.fetch_add(bytes, std::memory_order_relaxed);
          return true;
        },
        this);
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_SPHERE_POINT);
    auto* const vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 4 * sizeof(float), view.sphere_count));
    require(vertices != nullptr);
    for (std::size_t i = 0; i < view.sphere_count; ++i) {
      const kernel::Sphere& s = view.spheres[i];
      vertices[4 * i] = static_cast<float>(s.x);
      vertices[4 * i + 1] = static_cast<float>(s.y);
      vertices[4 * i + 2] = static_cast<float>(s.z);
      vertices[4 * i + 3] = static_cast<float>(s.radius);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
    require(rtcGetDeviceError(device_) == RTC_ERROR_NONE);
  }
  ~NativePoints() override {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  NativePoints(const NativePoints&) = delete;
  NativePoints& operator=(const NativePoints&) = delete;

  kernel::Tracer tracer() const noexcept override { return {nullptr, trace_points, scene_}; }
  std::string name() const override { return "embree " + embree_version() + ", sphere points"; }
  std::size_t bytes() const noexcept override { return static_cast<std::size_t>(bytes_); }

 private:
  RTCDevice device_;
  RTCScene scene_;
  std::atomic<std::int64_t> bytes_{0};
};

}  // namespace

std::unique_ptr<Accel> make_native_points(const kernel::SceneView& scene) {
  return std::make_unique<NativePoints>(scene);
}

}  // namespace orrery::accel
