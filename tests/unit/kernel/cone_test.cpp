// SPDX-License-Identifier: Apache-2.0
// Ray cones against differences of neighbouring rays, which are traced in long double.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "kernel/cone-inl.h"
#include "support/first_lane-inl.h"

namespace orrery::kernel {
/// A cone, scalar.
struct Moments {
  double width2 = 0, mixed = 0, slope2 = 0;

  double width2_at(double t) const { return width2 + 2 * t * mixed + t * t * slope2; }
};
struct ConeCase {
  Moments cone;
  double arriving[3] = {}, leaving[3] = {}, normal[3] = {};
  bool from_outside = true;
  double radius = 1, eta = 1, fuzz = 0;
  MaterialKind kind = MaterialKind::kMetal;
};
struct CameraConeCase {
  Camera camera;
  bool has_lens = false;
  double pixel[2] = {0, 0}, random[4] = {0.5, 0.5, 0.5, 0.5};
  double width = 1;
  Moments cone;
  double offset[3] = {}, direction[3] = {};
};
}  // namespace orrery::kernel

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

using One = hn::FixedTag<double, 1>;
using V1 = hn::Vec<One>;

Moments moments_of(const RayCone<V1>& cone) {
  return {hn::GetLane(cone.width2), hn::GetLane(cone.mixed), hn::GetLane(cone.slope2)};
}
Surface<One> surface_of(One d, const ConeCase& c) {
  Surface<One> at;
  at.direction = set3(d, c.arriving);
  at.normal = set3(d, c.normal);
  at.offset = c.from_outside ? at.normal : negated(at.normal);
  at.from_outside = hn::FirstN(d, c.from_outside ? 1 : 0);
  at.eta = hn::Set(d, c.eta);
  at.fuzz = hn::Set(d, c.fuzz);
  at.kind = hn::Set(IdTag<One>(), static_cast<hn::TFromD<IdTag<One>>>(c.kind));
  return at;
}
void scatter_cone(ConeCase& c, double width) {
  const One d;
  const RayCone<V1> cone{hn::Set(d, c.cone.width2), hn::Set(d, c.cone.mixed), hn::Set(d, c.cone.slope2)};
  c.cone = moments_of(scattered_cone(d, cone, surface_of(d, c), hn::Set(d, c.radius), set3(d, c.leaving), width));
}
void advance_cone(Moments& m, double distance) {
  const One d;
  const RayCone<V1> cone{hn::Set(d, m.width2), hn::Set(d, m.mixed), hn::Set(d, m.slope2)};
  m = moments_of(cone.advanced(hn::Set(d, distance)));
}
void camera_cone_case(CameraConeCase& c) {
  const One d;
  const Four<V1> random{
      {hn::Set(d, c.random[0]), hn::Set(d, c.random[1]), hn::Set(d, c.random[2]), hn::Set(d, c.random[3])}};
  SceneView scene;
  scene.camera = c.camera;
  scene.features.lens = c.has_lens;
  const auto camera = camera_vectors(d, scene, nullptr);
  const auto ray = camera_ray(d, scene, camera, hn::Set(d, c.pixel[0]), hn::Set(d, c.pixel[1]), random);
  c.cone = moments_of(camera_cone(d, scene, camera, ray.direction, c.width));
  math::set(c.offset, test::HWY_NAMESPACE::first_lane(ray.offset));
  math::set(c.direction, test::HWY_NAMESPACE::first_lane(ray.direction));
}

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace orrery::kernel {
namespace {

struct Vector {
  long double x = 0, y = 0, z = 0;

  // Friends, because operators of this namespace would hide those of lanes.
  friend Vector operator+(const Vector& a, const Vector& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Vector operator*(const Vector& a, long double s) { return {a.x * s, a.y * s, a.z * s}; }
};
long double dot(const Vector& a, const Vector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vector unit(const Vector& a) { return a * (1 / std::sqrt(dot(a, a))); }
void copy_to(double (&to)[3], const Vector& v) {
  to[0] = static_cast<double>(v.x);
  to[1] = static_cast<double>(v.y);
  to[2] = static_cast<double>(v.z);
}

/// A ray from `origin` that a sphere around the world's origin reflects or refracts.
struct Traced {
  Vector point, normal, direction;
  long double distance = 0;
  bool is_total = false;
};
Traced trace(const Vector& origin, const Vector& towards, long double radius, bool from_outside, bool reflects,
             long double eta) {
  const Vector direction = unit(towards);
  const long double middle = dot(origin, direction);
  const long double half = std::sqrt(middle * middle - dot(origin, origin) + radius * radius);
  Traced out;
  out.distance = -middle + (from_outside ? -half : half);
  out.point = origin + direction * out.distance;
  out.normal = out.point * ((from_outside ? 1 : -1) / radius);
  const long double cosine = -dot(direction, out.normal);
  if (reflects) {
    out.direction = direction + out.normal * (2 * cosine);
    return out;
  }
  const long double leaving2 = 1 - eta * eta * (1 - cosine * cosine);
  out.is_total = leaving2 < 0;
  if (!out.is_total) out.direction = direction * eta + out.normal * (eta * cosine - std::sqrt(leaving2));
  return out;
}

/// The cone of rays that leave a point of the plane y = 0 with slopes in y, after a sphere.
///
/// Result     the relative error of its widths at several distances, against a neighbouring ray
double error_of_cone(Vector origin, const Vector& towards, long double radius, bool from_outside, bool reflects,
                     double eta) {
  constexpr long double kSlope = 1e-7L;
  const Vector direction = unit(towards);
  const Traced centre = trace(origin, direction, radius, from_outside, reflects, static_cast<long double>(eta));
  const Traced beside =
      trace(origin, direction + Vector{0, kSlope, 0}, radius, from_outside, reflects, static_cast<long double>(eta));
  if (centre.is_total || beside.is_total) return 0;
  ConeCase c;
  c.kind = reflects ? MaterialKind::kMetal : MaterialKind::kDielectric;
  c.from_outside = from_outside;
  c.radius = static_cast<double>(radius);
  c.eta = eta;
  copy_to(c.arriving, direction);
  copy_to(c.leaving, centre.direction);
  copy_to(c.normal, centre.normal);
  const auto distance = static_cast<double>(centre.distance);
  c.cone = {distance * distance, distance, 1};
  HWY_NAMESPACE::scatter_cone(c, 0);
  double worst = 0;
  for (const double t : {0.0, 0.1, 0.7, 2.0, 9.0}) {
    const auto expected =
        static_cast<double>((beside.point + beside.direction * static_cast<long double>(t)).y / kSlope);
    const double scale = std::max({distance * distance, expected * expected, t * t});
    worst = std::max(worst, std::abs(c.cone.width2_at(t) - expected * expected) / scale);
  }
  return worst;
}

TEST(KernelCone, MirrorSpheresBendConesAsNeighbouringRaysShow) {
  for (const long double radius : {0.3L, 1.0L, 1000.0L})
    for (const long double across : {0.0L, 0.3L, 0.7L, 0.95L, 0.999L}) {
      EXPECT_LT(error_of_cone({across * radius, 0, radius + 2}, {0, 0, -1}, radius, true, true, 1), 1e-9)
          << "outside, " << double(radius) << ' ' << double(across);
      EXPECT_LT(error_of_cone({across * radius, 0, 0}, {0, 0, -1}, radius, false, true, 1), 1e-9)
          << "inside, " << double(radius) << ' ' << double(across);
    }
}

TEST(KernelCone, GlassSpheresBendConesAsNeighbouringRaysShow) {
  for (const long double radius : {0.3L, 1.0L, 1000.0L})
    for (const long double across : {0.0L, 0.3L, 0.6L, 0.95L}) {
      EXPECT_LT(error_of_cone({across * radius, 0, radius + 2}, {0, 0, -1}, radius, true, false, 1 / 1.5), 1e-9)
          << "entering, " << double(radius) << ' ' << double(across);
      EXPECT_LT(error_of_cone({across * radius, 0, 0}, {0, 0, -1}, radius, false, false, 1.5), 1e-9)
          << "leaving, " << double(radius) << ' ' << double(across);
      EXPECT_LT(error_of_cone({across * radius, 0, radius + 2}, {0, 0, -1}, radius, true, false, 1.5), 1e-9)
          << "a bubble in glass, " << double(radius) << ' ' << double(across);
    }
}

TEST(KernelCone, AConeMeasuredFromAPointAlongItIsTheSameCone) {
  const Moments cone{4, -1, 0.5};  // converges, as after a concave mirror
  Moments later = cone;
  HWY_NAMESPACE::advance_cone(later, 3);
  for (const double t : {0.0, 1.0, 5.0}) EXPECT_NEAR(later.width2_at(t), cone.width2_at(3 + t), 1e-14) << t;
  EXPECT_EQ(later.width2, 2.5);
}

TEST(KernelCone, AHugeSphereIsAPlane) {
  ConeCase c;
  const double cosine = 0.6, sine = 0.8;
  copy_to(c.arriving, {sine, 0, -cosine});
  copy_to(c.leaving, {sine, 0, cosine});
  copy_to(c.normal, {0, 0, 1});
  c.radius = 1e15;
  c.cone = {4, 1, 0.5};
  HWY_NAMESPACE::scatter_cone(c, 0);
  EXPECT_NEAR(c.cone.width2, 4, 1e-12);
  EXPECT_NEAR(c.cone.mixed, 1, 1e-12);
  EXPECT_NEAR(c.cone.slope2, 0.5, 1e-12);
}

TEST(KernelCone, LobesAddToTheSlopeAndDiffuseSurfacesReplaceIt) {
  ConeCase c;
  copy_to(c.arriving, {0, 0, -1});
  copy_to(c.leaving, {0, 0, 1});
  copy_to(c.normal, {0, 0, 1});
  c.radius = 1e15;
  c.cone = {4, 1, 0.5};
  c.fuzz = 0.3;
  ConeCase fuzzy = c, diffuse = c;
  HWY_NAMESPACE::scatter_cone(fuzzy, 0.125);
  EXPECT_NEAR(fuzzy.cone.slope2, 0.5 + 0.075 * 0.075, 1e-12) << "an eighth of an angle of 0.6";
  EXPECT_NEAR(fuzzy.cone.mixed, 1, 1e-12);
  for (const MaterialKind kind : {MaterialKind::kLambertian, MaterialKind::kHemisphere}) {
    ConeCase d = diffuse;
    d.kind = kind;
    d.fuzz = 0;
    d.radius = 0.1;
    HWY_NAMESPACE::scatter_cone(d, 0.125);
    EXPECT_EQ(d.cone.slope2, 0.0625);
    EXPECT_EQ(d.cone.mixed, 0);
    EXPECT_EQ(d.cone.width2, 4);
  }
}

/// Looks along -z; the focus plane is at distance 10, with half a unit per pixel.
CameraConeCase camera_case() {
  CameraConeCase c;
  c.camera.forward = {0, 0, -10};
  c.camera.right = {0.5, 0, 0};
  c.camera.down = {0, -0.5, 0};
  c.camera.lens_u = {2, 0, 0};
  c.camera.lens_v = {0, 2, 0};
  return c;
}

/// The squared distance between two cameras' rays, across the first, where the first has gone t.
double squared_gap(const CameraConeCase& a, const CameraConeCase& b, double t) {
  const auto vector = [](const double(&v)[3]) {
    return Vector{static_cast<long double>(v[0]), static_cast<long double>(v[1]), static_cast<long double>(v[2])};
  };
  const Vector direction = vector(a.direction);
  const Vector from = vector(b.offset) + vector(a.offset) * -1 + direction * -static_cast<long double>(t);
  const Vector along = vector(b.direction);
  const long double s = -dot(from, direction) / dot(along, direction);
  const Vector gap = from + along * s;
  return static_cast<double>(dot(gap, gap));
}

TEST(KernelCone, CameraConesAreAsWideAsThePixelAcrossTheRay) {
  // Pixels far from the centre, to the right: the pixel is seen at an angle in x, which is the smaller axis.
  for (const bool is_orthographic : {false, true})
    for (const double column : {0.0, 5.0, 25.0}) {
      CameraConeCase c = camera_case(), beside = c;
      c.camera.is_orthographic = beside.camera.is_orthographic = is_orthographic;
      constexpr double kStep = 1e-5;
      c.pixel[0] = column;
      c.pixel[1] = beside.pixel[1] = -0.5;
      beside.pixel[0] = column + kStep;
      HWY_NAMESPACE::camera_cone_case(c);
      HWY_NAMESPACE::camera_cone_case(beside);
      for (const double t : {0.5, 3.0, 40.0})
        EXPECT_NEAR(c.cone.width2_at(t) * kStep * kStep / squared_gap(c, beside, t), 1, 1e-4)
            << is_orthographic << ' ' << column << ' ' << t;
    }
  CameraConeCase c = camera_case();
  c.camera.right = {2, 0, 0};
  HWY_NAMESPACE::camera_cone_case(c);
  EXPECT_NEAR(c.cone.slope2, 0.05 * 0.05, 1e-4) << "the smaller side of a pixel that is not square";
}

TEST(KernelCone, LensesAddConesThatAreNarrowestInFocus) {
  for (const bool is_orthographic : {false, true}) {
    CameraConeCase c = camera_case();
    c.camera.is_orthographic = is_orthographic;
    c.pixel[0] = c.pixel[1] = -0.5;
    c.random[2] = 0;  // the centre of the lens
    c.width = 0.125;
    CameraConeCase pinhole = c;
    HWY_NAMESPACE::camera_cone_case(pinhole);
    c.has_lens = true;
    HWY_NAMESPACE::camera_cone_case(c);
    const double focus = 10 / -c.direction[2];
    EXPECT_NEAR(c.cone.width2_at(focus), pinhole.cone.width2_at(focus), 1e-12);
    // The lens is four units wide; at half the distance of focus and at 1.5 times it, its cone has half its width.
    for (const double t : {0.5, 1.5})
      EXPECT_NEAR(c.cone.width2_at(t * focus) - pinhole.cone.width2_at(t * focus), 0.0625, 1e-12);
    EXPECT_NEAR(c.cone.width2_at(0) - pinhole.cone.width2_at(0), 0.25, 1e-12);
  }
}

}  // namespace
}  // namespace orrery::kernel
