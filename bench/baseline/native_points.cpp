// SPDX-License-Identifier: Apache-2.0
#include "baseline/native_points.h"

#include <cmath>

#include "accel/embree_compat.h"
#include "base/error.h"

namespace orrery::bench::baseline {
namespace {

void require(bool holds) {
  if (!holds) throw base::Error(base::ErrorKind::kInternal, "Embree cannot build sphere points");
}

class NativePoints final : public Hittable {
 public:
  explicit NativePoints(std::vector<PlacedSphere> spheres)
      : spheres_(std::move(spheres)), device_(rtcNewDevice("threads=1")), scene_(rtcNewScene(device_)) {
    require(scene_ != nullptr);
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_SPHERE_POINT);
    auto* const vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 4 * sizeof(float), spheres_.size()));
    require(vertices != nullptr);
    for (std::size_t i = 0; i < spheres_.size(); ++i) {
      const PlacedSphere& s = spheres_[i];
      vertices[4 * i] = static_cast<float>(s.center.x);
      vertices[4 * i + 1] = static_cast<float>(s.center.y);
      vertices[4 * i + 2] = static_cast<float>(s.center.z);
      vertices[4 * i + 3] = static_cast<float>(std::abs(s.radius));
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

  bool hit(const Ray& ray, Interval t, HitRecord& record) const override {
    RTCRayHit query{};
    query.ray.org_x = static_cast<float>(ray.origin.x);
    query.ray.org_y = static_cast<float>(ray.origin.y);
    query.ray.org_z = static_cast<float>(ray.origin.z);
    query.ray.dir_x = static_cast<float>(ray.direction.x);
    query.ray.dir_y = static_cast<float>(ray.direction.y);
    query.ray.dir_z = static_cast<float>(ray.direction.z);
    query.ray.tnear = static_cast<float>(t.min);
    query.ray.tfar = static_cast<float>(t.max);
    query.ray.mask = ~0u;
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    accel::EmbreeContext context;
    accel::init(context);
    accel::intersect(scene_, context, query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;

    const PlacedSphere& sphere = spheres_[query.hit.primID];
    record.t = static_cast<double>(query.ray.tfar);
    record.point = ray.at(record.t);
    const Vec3d outward = (record.point - sphere.center) / sphere.radius;
    record.front_face = math::dot(ray.direction, outward) < 0;
    record.normal = record.front_face ? outward : -outward;
    record.material = sphere.material;
    return true;
  }

 private:
  std::vector<PlacedSphere> spheres_;
  RTCDevice device_;
  RTCScene scene_;
};

}  // namespace

std::unique_ptr<const Hittable> make_native_points(std::vector<PlacedSphere> spheres) {
  return std::make_unique<NativePoints>(std::move(spheres));
}

}  // namespace orrery::bench::baseline
