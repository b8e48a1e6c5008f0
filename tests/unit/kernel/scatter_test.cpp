// SPDX-License-Identifier: Apache-2.0
// Compares reflection, refraction and fuzz at single surface points with formulas. A white furnace cannot detect wrong
// proportions of reflected and refracted light.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "kernel/scatter-inl.h"
#include "support/first_lane-inl.h"

namespace orrery::kernel {
/// A ray incident on the top of a unit sphere, and its scattered directions.
struct ScatterCase {
  double cos_arriving = 1, eta = 1, r0 = 0, fuzz = 0, u = 0.5;
  FresnelKind fresnel = FresnelKind::kZero;
  double on_sphere[3] = {0, 1, 0};
  double glass[3] = {}, metal[3] = {}, reflectance = 0;
  bool metal_alive = false;
};
}  // namespace orrery::kernel

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

void scatter_case(ScatterCase& c) {
  const hn::FixedTag<double, 1> d;
  using D = decltype(d);
  Surface<std::remove_const_t<D>> at;
  const double arriving[3] = {std::sqrt(1 - c.cos_arriving * c.cos_arriving), -c.cos_arriving, 0}, up[3] = {0, 1, 0};
  at.direction = set3(d, arriving);
  at.offset = at.normal = set3(d, up);
  at.from_outside = hn::FirstN(d, 1);
  at.fuzz = hn::Set(d, c.fuzz);
  at.eta = hn::Set(d, c.eta);
  at.r0 = hn::Set(d, c.r0);
  at.fresnel = at.kind = hn::Set(IdTag<std::remove_const_t<D>>(), static_cast<std::uint64_t>(c.fresnel));
  math::set(c.glass, test::HWY_NAMESPACE::first_lane(sample_dielectric(d, at, hn::Set(d, c.u))));
  const auto metal = sample_metal(at, set3(d, c.on_sphere));
  math::set(c.metal, test::HWY_NAMESPACE::first_lane(metal.direction));
  c.metal_alive = !hn::AllFalse(d, metal.alive);
  const double sin_leaving = c.eta * arriving[0];
  c.reflectance = hn::GetLane(reflectance(d, at, hn::Set(d, c.cos_arriving),
                                          hn::Set(d, std::sqrt(std::max(0.0, 1 - sin_leaving * sin_leaving)))));
}

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace orrery::kernel {
namespace {

ScatterCase scattered(ScatterCase c) {
  HWY_NAMESPACE::scatter_case(c);
  return c;
}

constexpr double kCosines[] = {1.0, 0.9, 0.6, 0.3, 0.05};

TEST(KernelScatter, GlassRefractsBySnellAndReflectsBeyondTheCriticalAngle) {
  for (const double eta : {1 / 1.5, 1.0, 1.5}) {
    for (const double cosine : kCosines) {
      const ScatterCase c = scattered({.cos_arriving = cosine, .eta = eta});
      const double across = std::sqrt(1 - cosine * cosine), beyond = eta * across;
      const bool total = beyond > 1;
      EXPECT_NEAR(c.glass[0], total ? across : beyond, 1e-14) << eta << ' ' << cosine;
      EXPECT_NEAR(c.glass[1], total ? cosine : -std::sqrt(1 - beyond * beyond), 1e-14) << eta << ' ' << cosine;
    }
  }
}

TEST(KernelScatter, ReflectanceMatchesSchlickAndFresnel) {
  for (const double cosine : kCosines) {
    const double schlick = 0.04 + 0.96 * std::pow(1 - cosine, 5);
    EXPECT_NEAR(
        scattered({.cos_arriving = cosine, .eta = 1 / 1.5, .r0 = 0.04, .fresnel = FresnelKind::kSchlick}).reflectance,
        schlick, 1e-14);
    // Fresnel's equations in their sine and tangent form.
    const double a = std::acos(cosine), b = std::asin(std::sin(a) / 1.5);
    const double s = a == 0 ? 0.2 : std::sin(a - b) / std::sin(a + b),
                 p = a == 0 ? 0.2 : std::tan(a - b) / std::tan(a + b);
    EXPECT_NEAR(scattered({.cos_arriving = cosine, .eta = 1 / 1.5, .fresnel = FresnelKind::kExact}).reflectance,
                (s * s + p * p) / 2, 1e-14);
    EXPECT_EQ(scattered({.cos_arriving = cosine, .eta = 1 / 1.5, .r0 = 0.04}).reflectance, 0);
  }
}

TEST(KernelScatter, FuzzMovesTheUnitMirrorDirectionOntoASphere) {
  const ScatterCase c = scattered({.cos_arriving = 0.6, .fuzz = 0.5, .on_sphere = {0, 0, 1}});
  const double length = std::sqrt(1 + 0.5 * 0.5);
  EXPECT_NEAR(c.metal[0], 0.8 / length, 1e-14);
  EXPECT_NEAR(c.metal[1], 0.6 / length, 1e-14);
  EXPECT_NEAR(c.metal[2], 0.5 / length, 1e-14);
  EXPECT_TRUE(c.metal_alive);
}

TEST(KernelScatter, FuzzBelowTheSurfaceAbsorbs) {
  EXPECT_FALSE(scattered({.cos_arriving = 0.1, .fuzz = 1, .on_sphere = {0, -1, 0}}).metal_alive);
}

TEST(KernelScatter, FuzzThatCancelsTheMirrorDirectionAbsorbs) {
  EXPECT_FALSE(scattered({.cos_arriving = 1, .fuzz = 1, .on_sphere = {0, -1, 0}}).metal_alive);
}

}  // namespace
}  // namespace orrery::kernel
