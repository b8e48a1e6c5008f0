// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/core.h>

#include "base/error.h"
#include "film/picture.h"
#include "generate/generate.h"
#include "generate/generate_random.h"
#include "math/pixels.h"
#include "math/scalar.h"
#include "scene/limits.h"
#include "scene/value_text.h"
#include "sky/daylight.h"

namespace orrery::generate {
namespace {

using math::cosine;
using math::sine;
using math::Vec3d;

constexpr double kPi = std::numbers::pi;

void check_range(const char* name, double value, double from, double to) {
  if (!(value >= from && value <= to))
    base::refuse(fmt::format("{} is {}; must be in {}..{}", name, scene::number_text(value), scene::number_text(from),
                             scene::number_text(to)));
}

/// Returns a black latitude-longitude image.
film::Picture picture_of(int width) {
  if (width < kSmallestEnvironment || width > kLargestEnvironment || width % 4 != 0)
    base::refuse(fmt::format("width is {}; must be a multiple of 4 in {}..{}", width, kSmallestEnvironment,
                             kLargestEnvironment));
  film::Picture out;
  out.width = width;
  out.height = width / 2;
  out.color_interop_id = "lin_rec709_scene";
  const std::size_t texels = math::pixel_count(out.width, out.height);
  for (const char* name : {"R", "G", "B"}) out.planes.push_back({name, std::vector<float>(texels)});
  return out;
}

/// Directions of points of a latitude-longitude image, at a number of positions per texel and axis.
class Directions {
 public:
  Directions(int width, int positions) : positions_(positions) {
    for (int i = 0; i < width * positions; ++i) {
      const double longitude = kPi - (i + 0.5) / (width * positions) * 2 * kPi;
      longitudes_.push_back({sine(longitude), cosine(longitude)});
    }
    for (int i = 0; i < width / 2 * positions; ++i) {
      const double latitude = kPi / 2 - (i + 0.5) / (width * positions) * 2 * kPi;
      latitudes_.push_back({sine(latitude), cosine(latitude)});
    }
  }

  Vec3d operator()(int x, int y, int i = 0, int j = 0) const {
    const auto& [sin_x, cos_x] = longitudes_[static_cast<std::size_t>(x * positions_ + i)];
    const auto& [sin_y, cos_y] = latitudes_[static_cast<std::size_t>(y * positions_ + j)];
    return {cos_y * sin_x, sin_y, cos_y * cos_x};
  }

 private:
  struct SinCos {
    double sin, cos;
  };
  int positions_;
  std::vector<SinCos> longitudes_, latitudes_;
};

/// A soft box: a rectangle that emits towards its front.
struct SoftBox {
  Vec3d center;
  Vec3d right, up;  ///< from the centre to the edges
  Vec3d normal;     ///< unit, to the front
  double radiance;  ///< in the centre
};

/// Returns a soft box that faces a point, with horizontal upper and lower edges.
SoftBox facing(Vec3d center, Vec3d target, double width, double height, double radiance) {
  const Vec3d normal = math::normalized(target - center);
  const Vec3d side = std::abs(normal.y) > 0.99 ? Vec3d{1, 0, 0} : math::normalized(math::cross({0, 1, 0}, normal));
  return {center, side * (width / 2), math::cross(normal, side) * (height / 2), normal, radiance};
}

// Metres. The values are documented in the manual (cli/generate_command.cpp).
constexpr double kFloor = -1.2, kCeiling = 2.4, kWall = 3;
constexpr double kFloorAlbedo = 0.3, kWallAlbedo = 0.08;
/// Radiance at the edge of a soft box, relative to its centre: the cloth is illuminated from behind the centre.
constexpr double kEdge = 0.6;

std::array<SoftBox, 4> soft_boxes() {
  return {facing({-1.7, 1.3, 1.6}, {0, 0, 0}, 1.2, 1.2, 18),   // key: left of the camera
          facing({2.1, 0.5, 1.3}, {0, 0, 0}, 0.8, 1.6, 3),     // fill: right of the camera
          facing({1.3, 0.9, -2.2}, {0, 0, 0}, 0.35, 1.8, 25),  // rim: a strip behind the ball
          facing({0, 2.2, -0.4}, {0, 0, -0.4}, 1.8, 1.0, 4)};  // overhead
}

/// Returns the radiance of a soft box at a position of -1..1 in both directions.
double radiance_at(const SoftBox& box, double x, double y) {
  return box.radiance * (1 - (1 - kEdge) * (x * x + y * y) / 2);
}

/// The point of the room in a direction from the origin.
struct Surface {
  Vec3d position, normal;
  double albedo;
};
Surface room_at(Vec3d d) {
  const double to_floor = (d.y < 0 ? kFloor : kCeiling) / d.y;
  const double to_x = kWall / std::abs(d.x), to_z = kWall / std::abs(d.z);
  if (to_floor <= to_x && to_floor <= to_z)
    return {d * to_floor, {0, d.y < 0 ? 1.0 : -1.0, 0}, d.y < 0 ? kFloorAlbedo : kWallAlbedo};
  if (to_x <= to_z) return {d * to_x, {d.x < 0 ? 1.0 : -1.0, 0, 0}, kWallAlbedo};
  return {d * to_z, {0, 0, d.z < 0 ? 1.0 : -1.0}, kWallAlbedo};
}

/// Returns the radiance of a diffuse surface that the soft boxes illuminate, without shadows.
double reflected(const Surface& s, const std::array<SoftBox, 4>& boxes) {
  constexpr int kNodes = 6;
  double irradiance = 0;
  for (const SoftBox& box : boxes) {
    const double area = 4 * math::length(box.right) * math::length(box.up) / (kNodes * kNodes);
    for (int i = 0; i < kNodes; ++i) {
      for (int j = 0; j < kNodes; ++j) {
        const double x = (2 * i + 1.0) / kNodes - 1, y = (2 * j + 1.0) / kNodes - 1;
        const Vec3d way = box.center + box.right * x + box.up * y - s.position;
        const double squared = math::dot(way, way);
        const double cosines = std::max(math::dot(way, s.normal), 0.0) * std::max(-math::dot(way, box.normal), 0.0);
        irradiance += radiance_at(box, x, y) * area * cosines / (squared * squared);
      }
    }
  }
  return s.albedo / kPi * irradiance;
}

/// Returns the radiance of the soft boxes in a direction, and adds to `uncovered` if there is none.
double emitted(Vec3d d, const std::array<SoftBox, 4>& boxes, int& uncovered) {
  for (const SoftBox& box : boxes) {
    const double facing_it = math::dot(d, box.normal);
    if (facing_it >= 0) continue;  // away from the box, or at its back
    const double t = math::dot(box.center, box.normal) / facing_it;
    if (t <= 0) continue;
    const Vec3d from_center = d * t - box.center;
    const double x = math::dot(from_center, box.right) / math::dot(box.right, box.right);
    const double y = math::dot(from_center, box.up) / math::dot(box.up, box.up);
    if (std::abs(x) <= 1 && std::abs(y) <= 1) return radiance_at(box, x, y);
  }
  ++uncovered;
  return 0;
}

/// Adds the part of the sun's disc that is above the horizon: every texel receives the mean over its area.
void add_sun(const scene::Sun& sun, film::Picture& picture) {
  // Some fifteen positions across the disc, also if a texel is much larger.
  const int positions = std::max(8, 10240 / picture.width);
  const Directions directions(picture.width, positions);
  // A direction is in the disc if the squared length of its difference to the centre is at most this.
  const double disc = 2 * sun.one_minus_cos;
  const double diagonal = 2 * kPi / picture.width;  // at least half the diagonal of a texel
  const double nearby = (std::sqrt(disc) + diagonal) * (std::sqrt(disc) + diagonal);
  struct Part {
    std::size_t texel;
    double covered;
  };
  std::vector<Part> parts;
  double solid_angle = 0;
  const Directions centers(picture.width, 1);
  for (int y = 0; y < picture.height / 2; ++y) {
    const double row = 2 * kPi / picture.width *
                       (sine(kPi / 2 - y * kPi / picture.height) - sine(kPi / 2 - (y + 1) * kPi / picture.height));
    for (int x = 0; x < picture.width; ++x) {
      const Vec3d center = centers(x, y) - sun.direction;
      if (math::dot(center, center) > nearby) continue;
      int inside = 0;
      for (int j = 0; j < positions; ++j) {
        for (int i = 0; i < positions; ++i) {
          const Vec3d d = directions(x, y, i, j) - sun.direction;
          inside += math::dot(d, d) <= disc ? 1 : 0;
        }
      }
      if (inside == 0) continue;
      const double covered = static_cast<double>(inside) / (positions * positions);
      parts.push_back({math::pixel_index(x, y, picture.width), covered});
      solid_angle += covered * row;
    }
  }
  if (parts.empty()) return;
  // Positions in texels are counted, so the area of the disc is not exact.
  const double exact = 2 * kPi * sun.one_minus_cos / solid_angle;
  for (const Part& part : parts) {
    picture.planes[0].values[part.texel] += static_cast<float>(sun.radiance.x * part.covered * exact);
    picture.planes[1].values[part.texel] += static_cast<float>(sun.radiance.y * part.covered * exact);
    picture.planes[2].values[part.texel] += static_cast<float>(sun.radiance.z * part.covered * exact);
  }
}

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

film::Picture make_studio(int width) {
  constexpr int kPositions = 4;
  film::Picture picture = picture_of(width);
  const Directions centers(width, 1), directions(width, kPositions);
  const std::array<SoftBox, 4> boxes = soft_boxes();
  std::size_t at = 0;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x, ++at) {
      int uncovered = 0;
      double light = 0;
      for (int j = 0; j < kPositions; ++j)
        for (int i = 0; i < kPositions; ++i) light += emitted(directions(x, y, i, j), boxes, uncovered);
      if (uncovered > 0) light += uncovered * reflected(room_at(centers(x, y)), boxes);
      for (film::Plane& plane : picture.planes)
        plane.values[at] = static_cast<float>(light / (kPositions * kPositions));
    }
  }
  return picture;
}

film::Picture make_sky(const scene::Background& sky, int width) {
  film::Picture picture = picture_of(width);
  check_range("sun elevation", sky.sun_elevation, -90, 90);
  check_range("sun azimuth", sky.sun_azimuth, -scene::kLargestRotation, scene::kLargestRotation);
  check_range("turbidity", sky.turbidity, scene::kLowestTurbidity, scene::kHighestTurbidity);
  check_range("ground albedo", sky.ground_albedo.x, 0, 1);
  const scene::LatLongMap image = sky::bake_sky(sky, {width});
  for (int y = 0; y < picture.height; ++y) {
    const float* from = image.row(y);
    const std::size_t at = math::pixel_index(0, y, width);
    for (std::size_t x = 0; x < static_cast<std::size_t>(width); ++x)
      for (film::Plane& plane : picture.planes) plane.values[at + x] = *from++;
  }
  add_sun(image.sun, picture);
  return picture;
}

film::Picture make_planet(std::uint64_t seed, int width) {
  const Planet planet(seed);
  film::Picture out = picture_of(width);
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
      const std::size_t at = math::pixel_index(x, y, width);
      out.planes[0].values[at] = static_cast<float>(color.x);
      out.planes[1].values[at] = static_cast<float>(color.y);
      out.planes[2].values[at] = static_cast<float>(color.z);
    }
  }
  return out;
}

}  // namespace orrery::generate
