// SPDX-License-Identifier: Apache-2.0
#include "baseline/native_points.h"

#include <cmath>

#include "support/sphere_points.h"

namespace orrery::bench::baseline {
namespace {

class NativePoints final : public Hittable {
 public:
  explicit NativePoints(std::vector<PlacedSphere> spheres) : spheres_(std::move(spheres)), scene_("threads=1") {
    accel::build_sphere_points(scene_, spheres_.size(), [&](std::size_t i) {
      const PlacedSphere& s = spheres_[i];
      return kernel::Sphere{s.center.x, s.center.y, s.center.z, std::abs(s.radius)};
    });
  }

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
    accel::query(scene_.get(), context, query);
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
  accel::OwnedScene scene_;
};

}  // namespace

std::unique_ptr<const Hittable> make_native_points(std::vector<PlacedSphere> spheres) {
  return std::make_unique<NativePoints>(std::move(spheres));
}

}  // namespace orrery::bench::baseline
