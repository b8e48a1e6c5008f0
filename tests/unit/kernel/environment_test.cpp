// SPDX-License-Identifier: Apache-2.0
// Lookups in latitude-longitude maps against an independent formula in long double. Sampling is tested in
// tests/statistical/environment_test.cpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "kernel/environment-inl.h"

namespace orrery::kernel {
/// A direction and the radiance from there.
struct Look {
  double x = 0, y = 0, z = 0;
  double rgb[3] = {};
};
}  // namespace orrery::kernel

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

template <class D>
void look_all(D d, const Environment& env, std::vector<Look>& looks) {
  using T = hn::TFromD<D>;
  HWY_ALIGN T v[3][hn::MaxLanes(D())] = {};
  for (std::size_t i = 0; i < looks.size(); i += hn::Lanes(d)) {
    const std::size_t end = std::min(looks.size() - i, hn::Lanes(d));
    for (std::size_t k = 0; k < end; ++k) {
      v[0][k] = static_cast<T>(looks[i + k].x);
      v[1][k] = static_cast<T>(looks[i + k].y);
      v[2][k] = static_cast<T>(looks[i + k].z);
    }
    const auto radiance = environment_radiance(d, env, load3(d, v[0], v[1], v[2]));
    hn::Store(radiance.x, d, v[0]);
    hn::Store(radiance.y, d, v[1]);
    hn::Store(radiance.z, d, v[2]);
    for (std::size_t k = 0; k < end; ++k)
      for (std::size_t c = 0; c < 3; ++c) looks[i + k].rgb[c] = static_cast<double>(v[c][k]);
  }
}
void look_double(const Environment& env, std::vector<Look>& looks) { look_all(hn::ScalableTag<double>(), env, looks); }
void look_float(const Environment& env, std::vector<Look>& looks) { look_all(hn::ScalableTag<float>(), env, looks); }
void look_one(const Environment& env, std::vector<Look>& looks) { look_all(hn::FixedTag<double, 1>(), env, looks); }

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace orrery::kernel {
namespace {

/// A map and its view.
struct Map {
  int width, height;
  std::vector<float> texels;
  Environment view;

  Map(int w, int h) : width(w), height(h), texels(static_cast<std::size_t>(3 * w * h + 1)) {
    view.texels = texels.data();
    view.width = static_cast<std::uint32_t>(w);
    view.height = static_cast<std::uint32_t>(h);
  }
  Map(const Map&) = delete;
  float& at(int x, int y, int c) { return texels[static_cast<std::size_t>(3 * (y * width + x) + c)]; }
};

/// Red is 1 on the side of +x, green above, blue on the side of +z.
void fill_halves(Map& map) {
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) {
      map.at(x, y, 0) = 2 * x < map.width ? 1.0F : 0.0F;
      map.at(x, y, 1) = 2 * y < map.height ? 1.0F : 0.0F;
      map.at(x, y, 2) = 4 * x >= map.width && 4 * x < 3 * map.width ? 1.0F : 0.0F;
    }
}

Look seen(const Map& map, double x, double y, double z) {
  std::vector<Look> one = {{x, y, z}};
  HWY_NAMESPACE::look_double(map.view, one);
  return one[0];
}

TEST(KernelEnvironment, MapsHaveTheOrientationOfOpenExr) {
  Map map(64, 32);
  fill_halves(map);
  EXPECT_EQ(seen(map, 1, 0, 0).rgb[0], 1);
  EXPECT_EQ(seen(map, -1, 0, 0).rgb[0], 0);
  EXPECT_EQ(seen(map, 0, 1, 0).rgb[1], 1);
  EXPECT_EQ(seen(map, 0, -1, 0).rgb[1], 0);
  EXPECT_EQ(seen(map, 0, 0, 1).rgb[2], 1);
  EXPECT_EQ(seen(map, 0, 0, -1).rgb[2], 0);
  // Halfway across an edge between texels.
  EXPECT_EQ(seen(map, 0, 0, 1).rgb[0], 0.5);
  EXPECT_EQ(seen(map, 1, 0, 0).rgb[1], 0.5);
  EXPECT_EQ(seen(map, 1, 0, 0).rgb[2], 0.5);
  EXPECT_EQ(seen(map, 0, 0, -1).rgb[0], 0.5) << "left and right edge of the map";
}

TEST(KernelEnvironment, RotationTurnsTheMapAboutTheYAxis) {
  Map map(64, 32);
  fill_halves(map);
  map.view.turn = 0.25;  // +z becomes +x, +x becomes -z
  EXPECT_EQ(seen(map, 1, 0, 0).rgb[2], 1);
  EXPECT_EQ(seen(map, -1, 0, 0).rgb[2], 0);
  EXPECT_EQ(seen(map, 0, 0, -1).rgb[0], 1);
  EXPECT_EQ(seen(map, 0, 0, 1).rgb[0], 0);
  EXPECT_EQ(seen(map, 0, 1, 0).rgb[1], 1);
}

TEST(KernelEnvironment, TheSunIsAddedInsideItsCone) {
  Map map(8, 4);
  std::fill(map.texels.begin(), map.texels.end(), 0.5F);
  map.view.has_sun = true;
  map.view.sun_one_minus_cos = 1e-5;
  map.view.sun_radiance.x = 100;
  const double inside = std::sqrt(2e-5) * 0.999, outside = std::sqrt(2e-5) * 1.001;
  EXPECT_EQ(seen(map, std::sin(inside), std::cos(inside), 0).rgb[0], 100.5);
  EXPECT_EQ(seen(map, std::sin(outside), std::cos(outside), 0).rgb[0], 0.5);
  EXPECT_EQ(seen(map, 0, 1, 0).rgb[1], 0.5);
  EXPECT_EQ(seen(map, 0, -1, 0).rgb[0], 0.5);
}

/// Bilinear lookup in long double.
double expected(Map& map, const Look& at, int channel) {
  const long double pi = std::numbers::pi_v<long double>;
  const long double longitude = std::atan2(static_cast<long double>(at.x), static_cast<long double>(at.z));
  const long double latitude = std::atan2(static_cast<long double>(at.y),
                                          std::hypot(static_cast<long double>(at.x), static_cast<long double>(at.z)));
  const long double u = 0.5L - longitude / (2 * pi) + static_cast<long double>(map.view.turn);
  const long double across = (u - std::floor(u)) * map.width - 0.5L, down = (0.5L - latitude / pi) * map.height - 0.5L;
  const auto x = static_cast<int>(std::floor(across)), y = static_cast<int>(std::floor(down));
  const auto texel = [&](int dx, int dy) {
    return static_cast<long double>(
        map.at((x + dx + map.width) % map.width, std::clamp(y + dy, 0, map.height - 1), channel));
  };
  const long double s = across - x, t = down - y;
  return static_cast<double>((1 - t) * ((1 - s) * texel(0, 0) + s * texel(1, 0)) +
                             t * ((1 - s) * texel(0, 1) + s * texel(1, 1)));
}

std::vector<Look> directions_of_all_kinds() {
  std::mt19937_64 random{7};
  std::normal_distribution<double> normal(0, 1);
  std::vector<Look> out;
  for (int i = 0; i < 4000; ++i) {
    Look look{normal(random), normal(random), normal(random)};
    const double beside = std::exp2(-60 * (i % 100) / 100.0);
    if (i % 4 == 1) look.x *= beside, look.z *= beside;            // beside a pole
    if (i % 4 == 2) look.x *= beside, look.z = -std::abs(look.z);  // beside the seam
    if (i % 4 == 3) look.y *= beside;                              // beside the equator
    const double length = std::sqrt(look.x * look.x + look.y * look.y + look.z * look.z);
    out.push_back({look.x / length, look.y / length, look.z / length});
  }
  for (const double one : {1.0, -1.0})
    out.insert(out.end(), {{one, 0, 0}, {0, one, 0}, {0, 0, one}, {-0.0, 0.0, one}, {0.0, -0.0, -1.0}});
  return out;
}

TEST(KernelEnvironment, LookupIsBilinearAndWrapsAround) {
  std::mt19937_64 random{11};
  std::uniform_real_distribution<float> uniform(0, 1);
  for (const auto& [width, height] : {std::pair{1, 1}, {2, 1}, {5, 3}, {64, 32}, {7, 20}}) {
    Map map(width, height);
    for (float& t : map.texels) t = uniform(random);
    map.view.turn = 0.3;
    std::vector<Look> looks = directions_of_all_kinds(), narrow = looks, one = looks;
    HWY_NAMESPACE::look_double(map.view, looks);
    HWY_NAMESPACE::look_float(map.view, narrow);
    HWY_NAMESPACE::look_one(map.view, one);
    for (std::size_t i = 0; i < looks.size(); ++i) {
      for (int c = 0; c < 3; ++c) {
        const double wanted = expected(map, looks[i], c);
        ASSERT_NEAR(looks[i].rgb[c], wanted, 1e-13) << looks[i].x << ' ' << looks[i].y << ' ' << looks[i].z;
        ASSERT_NEAR(narrow[i].rgb[c], wanted, 2e-5) << looks[i].x << ' ' << looks[i].y << ' ' << looks[i].z;
        ASSERT_EQ(one[i].rgb[c], looks[i].rgb[c]);
      }
    }
  }
}

TEST(KernelEnvironment, ADirectionThatIsNotANumberReadsInsideTheMap) {
  Map map(8, 4);
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN(), kInf = std::numeric_limits<double>::infinity();
  std::vector<Look> looks = {{kNaN, 0, 0}, {0, kNaN, 0}, {0, 0, kNaN},       {kNaN, kNaN, kNaN},
                             {kInf, 0, 0}, {0, kInf, 0}, {-kInf, kInf, kInf}};
  HWY_NAMESPACE::look_double(map.view, looks);  // under the address sanitizer, a read elsewhere fails
  HWY_NAMESPACE::look_float(map.view, looks);
  HWY_NAMESPACE::look_one(map.view, looks);
}

}  // namespace
}  // namespace orrery::kernel
