// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "baseline/hittable.h"
#include "baseline/random.h"

namespace orrery::bench::baseline {

/// The scattered ray and its attenuation.
struct Scattered {
  Ray ray;
  Vec3d attenuation;
};

class Material {
 public:
  virtual ~Material() = default;

  /// Result     false if the path is absorbed; `out` is not written then
  virtual bool scatter(const Ray& ray, const HitRecord& hit, Random& random, Scattered& out) const = 0;
};

inline Vec3d reflect(Vec3d v, Vec3d n) { return v - 2 * math::dot(v, n) * n; }

class Lambertian final : public Material {
 public:
  explicit Lambertian(Vec3d albedo) : albedo_(albedo) {}

  bool scatter(const Ray&, const HitRecord& hit, Random& random, Scattered& out) const override {
    constexpr double kNearZero = 1e-8;
    Vec3d w = hit.normal + random.on_sphere();
    if (std::abs(w.x) < kNearZero && std::abs(w.y) < kNearZero && std::abs(w.z) < kNearZero) w = hit.normal;
    out = {{hit.point, w}, albedo_};
    return true;
  }

 private:
  Vec3d albedo_;
};

class Metal final : public Material {
 public:
  Metal(Vec3d albedo, double fuzz) : albedo_(albedo), fuzz_(fuzz) {}

  bool scatter(const Ray& ray, const HitRecord& hit, Random& random, Scattered& out) const override {
    const Vec3d w = math::normalized(reflect(ray.direction, hit.normal)) + fuzz_ * random.on_sphere();
    if (math::dot(w, hit.normal) <= 0) return false;
    out = {{hit.point, w}, albedo_};
    return true;
  }

 private:
  Vec3d albedo_;
  double fuzz_;
};

class Dielectric final : public Material {
 public:
  explicit Dielectric(double ior) : ior_(ior) {}

  bool scatter(const Ray& ray, const HitRecord& hit, Random& random, Scattered& out) const override {
    const double eta = hit.front_face ? 1 / ior_ : ior_;
    const Vec3d v = math::normalized(ray.direction);
    const double cosine = std::min(-math::dot(v, hit.normal), 1.0);
    const double sine = std::sqrt(1 - cosine * cosine);
    const bool reflects = eta * sine > 1 || reflectance(cosine, eta) > random.unit();
    out = {{hit.point, reflects ? reflect(v, hit.normal) : refract(v, hit.normal, cosine, eta)}, {1, 1, 1}};
    return true;
  }

 private:
  static Vec3d refract(Vec3d v, Vec3d n, double cosine, double eta) {
    const Vec3d across = eta * (v + cosine * n);
    return across - std::sqrt(std::abs(1 - math::dot(across, across))) * n;
  }
  static double reflectance(double cosine, double eta) {
    const double r = (1 - eta) / (1 + eta);
    const double r0 = r * r;
    return r0 + (1 - r0) * std::pow(1 - cosine, 5);
  }

  double ior_;
};

}  // namespace orrery::bench::baseline
