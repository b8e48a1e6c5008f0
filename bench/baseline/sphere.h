// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "baseline/hittable.h"

namespace orrery::bench::baseline {

class Sphere final : public Hittable {
 public:
  /// Domain     the material outlives the sphere
  Sphere(Vec3d center, double radius, const Material* material)
      : center_(center), radius_(radius), material_(material) {}

  bool hit(const Ray& ray, Interval t, HitRecord& record) const override {
    const Vec3d to_center = center_ - ray.origin;
    const double a = math::dot(ray.direction, ray.direction);
    const double h = math::dot(ray.direction, to_center);
    const double c = math::dot(to_center, to_center) - radius_ * radius_;
    const double discriminant = h * h - a * c;
    if (discriminant < 0) return false;
    const double root = std::sqrt(discriminant);
    double nearest = (h - root) / a;
    if (!t.surrounds(nearest)) {
      nearest = (h + root) / a;
      if (!t.surrounds(nearest)) return false;
    }
    record.t = nearest;
    record.point = ray.at(nearest);
    const Vec3d outward = (record.point - center_) / radius_;
    record.front_face = math::dot(ray.direction, outward) < 0;
    record.normal = record.front_face ? outward : -outward;
    record.material = material_;
    return true;
  }

 private:
  Vec3d center_;
  double radius_;
  const Material* material_;
};

/// A linear list that tests every object.
class HittableList final : public Hittable {
 public:
  void add(std::unique_ptr<const Hittable> object) { objects_.push_back(std::move(object)); }

  bool hit(const Ray& ray, Interval t, HitRecord& record) const override {
    bool any = false;
    for (const auto& object : objects_) {
      if (!object->hit(ray, t, record)) continue;
      any = true;
      t.max = record.t;
    }
    return any;
  }

 private:
  std::vector<std::unique_ptr<const Hittable>> objects_;
};

}  // namespace orrery::bench::baseline
