// SPDX-License-Identifier: Apache-2.0
// Textures at hits, against cells and coordinates computed with 113 bits.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include <hwy/highway.h>

#include "kernel/isa.h"
#include "kernel/texture-inl.h"
#include "math/dispatch.h"
#include "support/quad_real.h"

namespace orrery::kernel {

/// A ray at a sphere, and the colour of the texture at the hit.
struct TextureLook {
  double origin[3] = {}, direction[3] = {};
  Sphere sphere{};
  double rgb[3] = {};
  double distance = -1;  ///< -1: the ray misses
};
/// A point given as a sum, and the colour of the texture there.
struct SolidPoint {
  double base[3] = {}, rest[3] = {}, outward[3] = {};
  double footprint2 = 0;
  double rgb[3] = {};
};

}  // namespace orrery::kernel

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

template <class D>
Vec3<hn::Vec<D>> set_all(D d, const double (&v)[3]) {
  return set3(d, v);
}

template <class D, Precision kPrecision>
void look_all(D d, const Texture& texture, std::vector<TextureLook>& looks) {
  using T = hn::TFromD<D>;
  const auto zero = hn::Zero(d);
  for (TextureLook& look : looks) {
    Rays<D> ray;
    ray.origin = set_all(d, look.origin);
    ray.origin_low = ray.offset = {zero, zero, zero};
    ray.direction = set_all(d, look.direction);
    ray.inverse_square = hn::Set(d, T(1)) / dot(ray.direction, ray.direction);
    ray.self = hn::Set(IdTag<D>(), hn::TFromD<IdTag<D>>{kNone});
    const auto sphere = broadcast(d, look.sphere);
    const auto no = hn::FirstN(d, 0);
    const auto hit = closest_distance<D, kPrecision>(d, ray, sphere, no);
    if (hn::AllFalse(d, hit.mask)) continue;
    const auto at = hit_point<D, kPrecision>(ray, sphere, no, hit.value);
    const auto point = texture_point<D, kPrecision>(d, ray, sphere, at.offset, at.outward, hit.value, zero);
    const auto color = texture_color(d, texture, point);
    look.distance = static_cast<double>(hn::GetLane(hit.value));
    look.rgb[0] = static_cast<double>(hn::GetLane(color.x));
    look.rgb[1] = static_cast<double>(hn::GetLane(color.y));
    look.rgb[2] = static_cast<double>(hn::GetLane(color.z));
  }
}
template <class D>
void evaluate_all(D d, const Texture& texture, std::vector<SolidPoint>& points) {
  for (SolidPoint& p : points) {
    const TexturePoint<D> at{set_all(d, p.base), set_all(d, p.rest), set_all(d, p.outward),
                             hn::Set(d, static_cast<hn::TFromD<D>>(p.footprint2))};
    const auto color = texture_color(d, texture, at);
    p.rgb[0] = static_cast<double>(hn::GetLane(color.x));
    p.rgb[1] = static_cast<double>(hn::GetLane(color.y));
    p.rgb[2] = static_cast<double>(hn::GetLane(color.z));
  }
}

using Wide = hn::ScalableTag<double>;
void look_exact(const Texture& t, std::vector<TextureLook>& v) { look_all<Wide, Precision::kExact>(Wide(), t, v); }
void look_book(const Texture& t, std::vector<TextureLook>& v) { look_all<Wide, Precision::kBook>(Wide(), t, v); }
void look_fast(const Texture& t, std::vector<TextureLook>& v) {
  using Narrow = hn::ScalableTag<float>;
  look_all<Narrow, Precision::kFast>(Narrow(), t, v);
}
void evaluate_double(const Texture& t, std::vector<SolidPoint>& v) { evaluate_all(Wide(), t, v); }
void evaluate_float(const Texture& t, std::vector<SolidPoint>& v) { evaluate_all(hn::ScalableTag<float>(), t, v); }
void evaluate_one(const Texture& t, std::vector<SolidPoint>& v) { evaluate_all(hn::FixedTag<double, 1>(), t, v); }

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#ifndef ORRERY_OTHER_SET
namespace orrery::kernel {

using LookUp = void(const Texture& texture, std::vector<TextureLook>& looks);
using Evaluate = void(const Texture& texture, std::vector<SolidPoint>& points);
ORRERY_DECLARE_INSTANCES(LookUp look_exact, look_book, look_fast;
                         Evaluate evaluate_double, evaluate_float, evaluate_one)

namespace {

using test::QuadReal;

Texture checker(double scale) {
  Texture out;
  out.scale = scale;
  return out;
}

/// Gradients of the noise: random unit vectors.
const std::vector<double>& gradients() {
  static const std::vector<double> all = [] {
    std::mt19937_64 random{3};
    std::normal_distribution<double> normal;
    std::vector<double> out;
    for (std::uint32_t i = 0; i < kGradients; ++i) {
      const double v[3] = {normal(random), normal(random), normal(random)};
      const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
      out.insert(out.end(), {v[0] / length, v[1] / length, v[2] / length, 0});
    }
    return out;
  }();
  return all;
}

Texture noise(TextureKind kind, double scale, std::uint32_t seed = 1) {
  Texture out;
  out.kind = kind;
  out.scale = scale;
  out.seed = seed;
  out.gradients = gradients().data();
  return out;
}

double value_at(const Texture& texture, double x, double y, double z, double base = 0) {
  std::vector<SolidPoint> one(1);
  one[0].base[0] = one[0].base[1] = one[0].base[2] = base;
  one[0].rest[0] = x;
  one[0].rest[1] = y;
  one[0].rest[2] = z;
  ORRERY_BEST_INSTANCE(evaluate_double)(texture, one);
  return one[0].rgb[0];
}

TEST(KernelTexture, CheckersAlternateAcrossTheOrigin) {
  const Texture texture = checker(0.5);
  for (int x = -5; x < 5; ++x)
    for (int y = -5; y < 5; ++y)
      for (int z = -5; z < 5; ++z) {
        const bool is_odd = (x + y + z) % 2 != 0;
        ASSERT_EQ(value_at(texture, (x + 0.25) / 2, (y + 0.5) / 2, (z + 0.75) / 2), is_odd ? 1 : 0);
        ASSERT_EQ(value_at(texture, x / 2.0, y / 2.0, z / 2.0), is_odd ? 1 : 0) << "the lower faces belong to a cell";
      }
  EXPECT_EQ(value_at(texture, -1e-300, 0.1, 0.1), 1) << "just below a face";
}

TEST(KernelTexture, CheckersNeedNoIntegers) {
  // 2^80 cells from the origin, where every number is a multiple of two cells, and next to it.
  const Texture texture = checker(1);
  EXPECT_EQ(value_at(texture, 0.5, 0.5, 0.5, 0x1p80), 0);
  EXPECT_EQ(value_at(texture, 1.5, 0.5, 0.5, 0x1p80), 1);
  EXPECT_EQ(value_at(texture, 0.5, 0.5, 0.5, -0x1p52 - 1), 1);
  EXPECT_EQ(value_at(texture, -0.5, 0.5, 0.5, 0x1p52 + 1), 0);
  // Neither overflows to a different colour.
  for (const double scale : {1e-18, 1e18})
    for (const double x : {-1e18, 1e18}) {
      std::vector<SolidPoint> one(1);
      one[0].base[0] = x;
      ORRERY_BEST_INSTANCE(evaluate_float)(checker(scale), one);
      EXPECT_TRUE(one[0].rgb[0] == 0 || one[0].rgb[0] == 1);
    }
}

/// A random look at a sphere of this radius from a height of up to 1.1 `away`; its centre is at random, about `place`
/// from the origin.
TextureLook random_look(std::mt19937_64& random, double radius, double away, double place) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0, 1);
  const auto unit = [&](double(&v)[3]) {
    for (double& c : v) c = normal(random);
    const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (double& c : v) c /= length;
  };
  TextureLook out;
  double up[3], aside[3];
  unit(up);
  unit(aside);
  out.sphere = {place * normal(random), place * normal(random), place * normal(random), radius};
  const double height = away * (0.1 + uniform(random));
  const double center[3] = {out.sphere.x, out.sphere.y, out.sphere.z};
  double length2 = 0;
  for (int k = 0; k < 3; ++k) {
    out.origin[k] = center[k] + up[k] * (radius + height);
    // To a point of the surface that is about as far to the side as the origin is high.
    const double spread = std::min(height, radius) * uniform(random);
    out.direction[k] = aside[k] * spread - up[k] * height;
    length2 += out.direction[k] * out.direction[k];
  }
  for (double& c : out.direction) c /= std::sqrt(length2);
  return out;
}

/// The cell of a hit.
struct Cells {
  double nearest_face;  ///< the smallest distance to a face, cells
  bool is_odd;
};
Cells expected_cells(const TextureLook& look, double scale) {
  const double center[3] = {look.sphere.x, look.sphere.y, look.sphere.z};
  QuadReal b = 0.0, c = 0.0, a = 0.0;
  for (int k = 0; k < 3; ++k) {
    const QuadReal from = QuadReal(look.origin[k]) - center[k];
    a = a + QuadReal(look.direction[k]) * look.direction[k];
    b = b + from * look.direction[k];
    c = c + from * from;
  }
  c = c - QuadReal(look.sphere.radius) * look.sphere.radius;
  const QuadReal t = c / (sqrt(b * b - a * c) - b);  // the nearer root: the origin is outside
  Cells out{0.5, false};
  for (int k = 0; k < 3; ++k) {
    const QuadReal at = (QuadReal(look.origin[k]) + t * look.direction[k]) / scale;
    double whole = std::floor(at.to_double());
    double part = (at - whole).to_double();
    if (part < 0) part += 1, whole -= 1;
    if (part >= 1) part -= 1, whole += 1;
    out.nearest_face = std::min({out.nearest_face, part, 1 - part});
    if (std::fmod(whole, 2) != 0) out.is_odd = !out.is_odd;
  }
  return out;
}

/// The largest distance from a face, in scene units, of hits in the wrong cell; relative to `unit(look)`.
template <class Unit>
double worst_cell(std::vector<TextureLook> looks, double scale,
                  void (*look_at)(const Texture&, std::vector<TextureLook>&), Unit unit, std::size_t& counted) {
  look_at(checker(scale), looks);
  double worst = 0;
  counted = 0;
  for (const TextureLook& look : looks) {
    if (look.distance < 0) continue;
    ++counted;
    const Cells wanted = expected_cells(look, scale);
    if ((look.rgb[0] == 1) != wanted.is_odd) worst = std::max(worst, wanted.nearest_face * scale / unit(look));
  }
  return worst;
}

/// Distance to the hit, plus the origin's largest coordinate: what a double's spacing depends on.
double reach(const TextureLook& look) {
  return look.distance + std::max({std::abs(look.origin[0]), std::abs(look.origin[1]), std::abs(look.origin[2])});
}

/// Runs a check with every instruction set.
template <class Check>
void with_every_isa(Check check) {
  for (const std::string& isa : available_isas()) {
    ASSERT_TRUE(limit_isa(isa));
    check(isa);
  }
  ASSERT_TRUE(limit_isa(""));
}

TEST(KernelTexture, CellsOfCheckersAtAllRadii) {
  // Cells of a twentieth of the radius, seen from a few radii away; the centre up to 10 radii from the origin. Then
  // cells so small that the error of the point shows.
  with_every_isa([](const std::string& isa) {
    std::mt19937_64 random{5};
    for (const double radius : {1e-12, 1e-6, 1.0, 1e3, 1e6, 1e12}) {
      std::vector<TextureLook> looks;
      for (int i = 0; i < 4000; ++i) looks.push_back(random_look(random, radius, 3 * radius, 10 * radius));
      std::size_t counted = 0;
      const auto of_radius = [&](const TextureLook&) { return radius; };
      EXPECT_EQ(worst_cell(looks, radius / 20, ORRERY_BEST_INSTANCE(look_exact), of_radius, counted), 0) << radius;
      EXPECT_GT(counted, 2000U);
      const double exact = worst_cell(looks, radius * 1e-12, ORRERY_BEST_INSTANCE(look_exact), of_radius, counted);
      EXPECT_LT(exact, 5e-14) << radius;
      const double fast = worst_cell(looks, radius * 1e-3, ORRERY_BEST_INSTANCE(look_fast), of_radius, counted);
      EXPECT_LT(fast, 1e-5) << radius;
      std::printf("%s, radius %g: exact %.1e, fast %.1e radii\n", isa.c_str(), radius, exact, fast);
    }
  });
}

TEST(KernelTexture, CellsOfCheckersOnAGroundOfAnyRadius) {
  // A sphere that touches the plane y = 0, the face of two layers of cells, seen from a few units above.
  with_every_isa([](const std::string& isa) {
    std::mt19937_64 random{6};
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (const double radius : {1e1, 1e3, 1e6, 1e9, 1e12}) {
      std::vector<TextureLook> looks;
      for (int i = 0; i < 4000; ++i) {
        TextureLook look;
        look.sphere = {0, -radius, 0, radius};
        const double v[3] = {uniform(random), -std::abs(uniform(random)) - 0.01, uniform(random)};
        const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
        for (int k = 0; k < 3; ++k) look.direction[k] = v[k] / length;
        look.origin[0] = 3 * uniform(random);
        look.origin[1] = 1.5 + uniform(random);
        look.origin[2] = 3 * uniform(random);
        looks.push_back(look);
      }
      std::size_t counted = 0;
      EXPECT_EQ(worst_cell(looks, 0.32, ORRERY_BEST_INSTANCE(look_exact), reach, counted), 0) << radius;
      EXPECT_GT(counted, 1500U);
      const double exact = worst_cell(looks, 1e-13, ORRERY_BEST_INSTANCE(look_exact), reach, counted);
      EXPECT_LT(exact, 1e-15) << radius;
      const double fast = worst_cell(looks, 1e-3, ORRERY_BEST_INSTANCE(look_fast), reach, counted);
      EXPECT_LT(fast, 1e-6) << radius;
      std::printf("%s, ground %g: exact %.1e, fast %.1e of the distance\n", isa.c_str(), radius, exact, fast);
    }
  });
}

TEST(KernelTexture, TheBooksPrecisionUsesTheBooksPoint) {
  std::vector<TextureLook> looks(1);
  looks[0].origin[2] = 3;
  looks[0].direction[2] = -1;
  looks[0].sphere = {0, 0, 0, 1};
  ORRERY_BEST_INSTANCE(look_book)(checker(0.75), looks);
  EXPECT_EQ(looks[0].rgb[0], 1);  // z = 1 is in cell 1, x = y = 0 in cells 0
}

std::vector<SolidPoint> random_points(double extent) {
  std::mt19937_64 random{9};
  std::uniform_real_distribution<double> uniform(-extent, extent);
  std::vector<SolidPoint> out(3000);
  for (SolidPoint& p : out)
    for (int k = 0; k < 3; ++k) {
      p.base[k] = uniform(random);
      p.rest[k] = uniform(random) / 1000;
    }
  return out;
}

TEST(KernelTexture, NoiseIsZeroAtLatticePointsAndBounded) {
  const Texture texture = noise(TextureKind::kNoise, 4);
  for (int x = -3; x < 3; ++x) EXPECT_EQ(value_at(texture, x / 4.0, 0.25, -0.75), 0.5);
  double lowest = 1, highest = 0, sum = 0;
  std::vector<SolidPoint> points = random_points(1000);
  ORRERY_BEST_INSTANCE(evaluate_double)(texture, points);
  for (const SolidPoint& p : points) {
    lowest = std::min(lowest, p.rgb[0]);
    highest = std::max(highest, p.rgb[0]);
    sum += p.rgb[0] / static_cast<double>(points.size());
  }
  EXPECT_GT(lowest, 0.5 - std::sqrt(3.0) / 4);
  EXPECT_LT(highest, 0.5 + std::sqrt(3.0) / 4);
  EXPECT_GT(highest - lowest, 0.5);
  EXPECT_NEAR(sum, 0.5, 0.01);
}

TEST(KernelTexture, NoiseIsContinuousAcrossCells) {
  for (const TextureKind kind : {TextureKind::kNoise, TextureKind::kTurbulence, TextureKind::kMarble}) {
    const Texture texture = noise(kind, 4);
    for (int i = -20; i < 20; ++i) {
      const double face = i / 4.0;
      EXPECT_NEAR(value_at(texture, face - 1e-9, 0.3, 0.7), value_at(texture, face + 1e-9, 0.3, 0.7), 1e-6);
      EXPECT_NEAR(value_at(texture, 0.3, face - 1e-9, 0.7), value_at(texture, 0.3, face + 1e-9, 0.7), 1e-6);
      EXPECT_NEAR(value_at(texture, 0.3, 0.7, face - 1e-9), value_at(texture, 0.3, 0.7, face + 1e-9), 1e-6);
    }
  }
}

TEST(KernelTexture, ASumKeepsThePrecisionOfItsSmallPart) {
  const Texture texture = noise(TextureKind::kNoise, 1);
  EXPECT_EQ(value_at(texture, 0.3, 0.2, 0.1, 0x1p40), value_at(texture, 0.3, 0.2, 0.1, -0x1p40))
      << "the period is 2^31";
  for (const double x : {0.3, 0.7001, 0.11}) {
    const double near = value_at(texture, x, x, x, 0x1p40);
    const double far = value_at(texture, x + 0x1p-45, x, x, 0x1p40);
    EXPECT_NE(near, far) << "a step of 2^-45 beside a base of 2^40";
    EXPECT_NEAR(near, far, 1e-12);
  }
}

TEST(KernelTexture, TheSeedChangesTheNoise) {
  int equal = 0;
  for (int i = 0; i < 100; ++i) {
    const double x = 0.37 * i + 0.1;
    if (value_at(noise(TextureKind::kNoise, 1, 1), x, 0.3, 0.4) ==
        value_at(noise(TextureKind::kNoise, 1, 2), x, 0.3, 0.4))
      ++equal;
  }
  EXPECT_LT(equal, 5);
}

TEST(KernelTexture, MarbleIsAWaveAlongZThatTurbulenceDistorts) {
  Texture texture = noise(TextureKind::kTurbulence, 1);
  for (int i = 0; i < 200; ++i) {
    const double x = 0.013 * i - 1, y = 0.4 + 0.002 * i, z = 0.03 * i - 3;
    texture.kind = TextureKind::kTurbulence;
    texture.scale = 1;
    const double turmoil = value_at(texture, x, y, z);
    if (turmoil == 1) continue;  // clamped
    texture.kind = TextureKind::kMarble;
    texture.scale = 4;
    EXPECT_NEAR(value_at(texture, x, y, z), 0.5 * (1 + std::sin(4 * z + 10 * turmoil)), 1e-13);
  }
}

TEST(KernelTexture, LanesAndPrecisionsAgree) {
  for (const TextureKind kind :
       {TextureKind::kChecker, TextureKind::kNoise, TextureKind::kTurbulence, TextureKind::kMarble}) {
    const Texture texture = noise(kind, 4);
    std::vector<SolidPoint> wide = random_points(10), one = wide, narrow = wide;
    ORRERY_BEST_INSTANCE(evaluate_double)(texture, wide);
    ORRERY_BEST_INSTANCE(evaluate_one)(texture, one);
    ORRERY_BEST_INSTANCE(evaluate_float)(texture, narrow);
    double worst = 0;
    for (std::size_t i = 0; i < wide.size(); ++i) {
      ASSERT_EQ(wide[i].rgb[0], one[i].rgb[0]);
      worst = std::max(worst, std::abs(wide[i].rgb[0] - narrow[i].rgb[0]));
    }
    if (kind == TextureKind::kChecker) continue;  // a point beside a face
    std::printf("kind %d: single differs from double precision by %.1e\n", static_cast<int>(kind), worst);
    EXPECT_LT(worst, 1e-4);
  }
}

TEST(KernelTexture, ImagesAreSeenFromOutsideAsInTheBook) {
  // The left edge of the image is at -x, and the image goes on through +z, +x and -z; its top is at +y.
  std::vector<float> texels(3 * 8 * 4 + 1);
  for (std::size_t y = 0; y < 4; ++y)
    for (std::size_t x = 0; x < 8; ++x) {
      texels[3 * (8 * y + x)] = static_cast<float>(x);
      texels[3 * (8 * y + x) + 1] = static_cast<float>(y);
    }
  TextureImage map;
  map.levels[0] = {texels.data(), 8, 4};
  map.level_count = 1;
  map.turn = 0.75;
  Texture texture;
  texture.kind = TextureKind::kImage;
  texture.image = &map;
  const auto seen = [&](double x, double y, double z) {
    std::vector<SolidPoint> one(1);
    one[0].outward[0] = x;
    one[0].outward[1] = y;
    one[0].outward[2] = z;
    ORRERY_BEST_INSTANCE(evaluate_double)(texture, one);
    return one[0];
  };
  EXPECT_NEAR(seen(-1, 0, 0).rgb[0], 3.5, 1e-12);  // between the last and the first column
  EXPECT_NEAR(seen(0, 0, 1).rgb[0], 1.5, 1e-12);
  EXPECT_NEAR(seen(1, 0, 0).rgb[0], 3.5, 1e-12);
  EXPECT_NEAR(seen(0, 0, -1).rgb[0], 5.5, 1e-12);
  EXPECT_NEAR(seen(std::sqrt(0.5), 0, std::sqrt(0.5)).rgb[0], 2.5, 1e-12);
  EXPECT_EQ(seen(0, 1, 0).rgb[1], 0);
  EXPECT_EQ(seen(0, -1, 0).rgb[1], 3);
  EXPECT_NEAR(seen(1, 0, 0).rgb[1], 1.5, 1e-12);
}

}  // namespace
}  // namespace orrery::kernel
#endif
