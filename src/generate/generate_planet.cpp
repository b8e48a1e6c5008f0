// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <fmt/core.h>

#include "base/error.h"
#include "film/picture.h"
#include "generate/generate.h"
#include "generate/generate_random.h"

namespace orrery::generate {
namespace {

using math::Vec3d;

Vec3d mixed(Vec3d a, Vec3d b, double t) { return a + (b - a) * t; }

/// 0 up to `from`, 1 from `to` on, and smooth between them.
double step_between(double from, double to, double x) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// Reflectances of a planet's surface and clouds by direction.
class Planet {
 public:
  explicit Planet(std::uint64_t seed)
      : relief_(4 * seed), climate_(4 * seed + 1), clouds_(4 * seed + 2), wind_(4 * seed + 3) {}

  Vec3d color(Vec3d p) const {
    constexpr Vec3d kCloud{0.85, 0.86, 0.88};
    return mixed(surface(p), kCloud, 0.9 * cloud_cover(p));
  }

 private:
  /// A point displaced by noise, so that what is computed from it has no round shapes.
  static Vec3d displaced(const GenerateNoise& noise, Vec3d p, double frequency, double by) {
    const Vec3d q = frequency * p;
    return p + by * Vec3d{noise.octaves(q, 4), noise.octaves(q + Vec3d{17.3, 5.1, 9.7}, 4),
                          noise.octaves(q + Vec3d{3.9, 31.7, 23.3}, 4)};
  }

  Vec3d surface(Vec3d p) const {
    constexpr Vec3d kDeep{0.008, 0.025, 0.09}, kShallow{0.03, 0.12, 0.19}, kIce{0.82, 0.85, 0.88};
    constexpr Vec3d kForest{0.035, 0.09, 0.025}, kSteppe{0.16, 0.15, 0.06}, kDesert{0.42, 0.31, 0.17},
        kRock{0.21, 0.18, 0.15};
    const double height = relief_.octaves(displaced(climate_, 1.7 * p, 1.3, 0.35), 9) - 0.06;
    const double rough = climate_.octaves(6 * p, 5), latitude = std::abs(p.y);
    const double ice = step_between(0.84, 0.9, latitude + 0.09 * rough + 0.25 * std::max(height, 0.0));
    if (height < 0) return mixed(mixed(kShallow, kDeep, step_between(0, 0.12, -height)), kIce, ice);
    // Dry around the tropics, wet at the equator and in middle latitudes.
    const double wet = std::abs(latitude - 0.38) * 3.2 - 0.45 + 0.8 * climate_.octaves(2.1 * p, 5);
    const Vec3d plain = wet < 0 ? mixed(kSteppe, kDesert, step_between(0, 0.4, -wet))
                                : mixed(kSteppe, kForest, step_between(0, 0.35, wet));
    return mixed(mixed(plain, kRock, step_between(0.25, 0.55, height + 0.2 * rough)), kIce, ice);
  }

  double cloud_cover(Vec3d p) const {
    // Streaks along the parallels, distorted by whirls.
    const Vec3d q = displaced(wind_, p, 2.2, 0.3);
    const double cover = clouds_.octaves({2.3 * q.x, 3.9 * q.y, 2.3 * q.z}, 8);
    return step_between(0.08, 0.65, cover + 0.12 * wind_.octaves(9 * p, 5));
  }

  GenerateNoise relief_, climate_, clouds_, wind_;
};

}  // namespace

film::Picture make_planet(std::uint64_t seed, int width) {
  if (width < kSmallestEnvironment || width > kLargestEnvironment || width % 4 != 0)
    throw base::Error(base::ErrorKind::kUsage, fmt::format("width is {}; must be a multiple of 4 in {}..{}", width,
                                                           kSmallestEnvironment, kLargestEnvironment));
  const Planet planet(seed);
  film::Picture out;
  out.width = width;
  out.height = width / 2;
  out.color_interop_id = "lin_rec709_scene";
  const std::size_t texels = static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height);
  for (const char* name : {"R", "G", "B"}) out.planes.push_back({name, std::vector<float>(texels)});
  // Rounded from long double, so that they do not depend on the math library.
  const auto sine = [](long double angle) { return static_cast<double>(std::sin(angle)); };
  const auto cosine = [](long double angle) { return static_cast<double>(std::cos(angle)); };
  const long double turn = 2 * std::numbers::pi_v<long double>;
  for (int y = 0; y < out.height; ++y) {
    const long double colatitude = turn * (y + 0.5L) / (2 * out.height);
    const double up = cosine(colatitude), aside = sine(colatitude);
    for (int x = 0; x < out.width; ++x) {
      const long double longitude = turn * ((x + 0.5L) / out.width - 0.25L);
      const Vec3d color = planet.color({aside * sine(longitude), up, aside * cosine(longitude)});
      const auto at = static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
      out.planes[0].values[at] = static_cast<float>(color.x);
      out.planes[1].values[at] = static_cast<float>(color.y);
      out.planes[2].values[at] = static_cast<float>(color.z);
    }
  }
  return out;
}

}  // namespace orrery::generate
