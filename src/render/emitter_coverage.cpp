// SPDX-License-Identifier: Apache-2.0
#include "render/emitter_coverage.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <vector>

#include "kernel/scene_view.h"
#include "math/scalar.h"
#include "math/vec3.h"

namespace orrery::render {
namespace {

using math::Vec3d;

/// Emitters that cover more of each pixel are found by the first samples.
constexpr double kLargestCoverage = 0.5;

/// Texels of a map count as emitters if they are brighter than its mean by this factor.
constexpr double kBrightTexel = 8;

/// The distance of the sky, in distances to the focus plane. The result does not depend on it as long as it is large.
constexpr double kSkyDistance = 0x1p40;

/// The camera when the shutter closes.
kernel::Camera closing_camera(const kernel::SceneView& scene) {
  kernel::Camera out = scene.camera;
  if (!scene.features.motion) return out;
  for (const auto vector : kernel::kCameraVectors) out.*vector = out.*vector + scene.camera_motion.*vector;
  return out;
}

/// The image of a sphere: a rectangle around it, and its area without the blur of the lens.
struct SphereImage {
  double x0, x1, y0, y1;  ///< px, relative to the rendered window
  double area;            ///< square pixels
};

/// Projects a sphere. Empty if the sphere is behind the camera or contains it.
std::optional<SphereImage> image_of(const kernel::Camera& camera, Vec3d center, double radius) {
  const Vec3d &forward = camera.forward, &right = camera.right, &down = camera.down;
  const Vec3d to = center - camera.origin, across = cross(right, down);
  const double determinant = dot(forward, across);
  const double depth = dot(to, across) / determinant;  // 1 at the focus plane
  if (!(depth * length(forward) > radius)) return std::nullopt;
  const double scale = camera.is_orthographic ? 1 : depth;
  const double x = dot(to, cross(down, forward)) / (determinant * scale) + camera.half_width;
  const double y = dot(to, cross(forward, right)) / (determinant * scale) + camera.half_height;
  const double pixel_width = scale * length(right), pixel_height = scale * length(down);  // at the sphere
  const double blurred = radius + length(camera.lens_u) * std::abs(1 - depth);
  return SphereImage{x - blurred / pixel_width, x + blurred / pixel_width, y - blurred / pixel_height,
                     y + blurred / pixel_height, std::numbers::pi * radius * radius / (pixel_width * pixel_height)};
}

/// Adds up the images of emitters.
class Coverage {
 public:
  Coverage(const kernel::SceneView& scene, int width_px, int height_px)
      : scene_(scene),
        width_(width_px),
        height_(height_px),
        margin_(scene.filter.places != nullptr ? scene.filter.places[kernel::PixelFilter::kSteps] - 0.5 : 0) {}

  /// `opening`, `closing`  spheres when the shutter opens and closes
  /// `radiance`            mean of the channels
  void add(const kernel::Sphere& opening, const kernel::Sphere& closing, double radiance, double opacity = 1) {
    const auto a = image_of(cameras_[0], {opening.x, opening.y, opening.z}, opening.radius);
    const auto b = image_of(cameras_[1], {closing.x, closing.y, closing.z}, closing.radius);
    if (!a || !b) return;
    const double left = std::floor(std::min(a->x0, b->x0) - margin_);
    const double right = std::floor(std::max(a->x1, b->x1) + margin_) + 1;
    const double top = std::floor(std::min(a->y0, b->y0) - margin_);
    const double bottom = std::floor(std::max(a->y1, b->y1) + margin_) + 1;
    if (!(right > 0 && left < width_ && bottom > 0 && top < height_)) return;
    const double coverage = opacity * (a->area + b->area) / 2 / ((right - left) * (bottom - top));
    if (!(coverage < kLargestCoverage)) return;
    corners_.resize(static_cast<std::size_t>(width_ + 1) * static_cast<std::size_t>(height_ + 1));
    for (const double x : {left, right})
      for (const double y : {top, bottom})
        corner(x, y) += Corner{coverage * radiance, coverage * radiance * radiance} * ((x == left) == (y == top) ? 1 : -1);
  }

  /// Adds an emitter as far away as the sky.
  ///
  /// `direction`  unit
  void add_distant(Vec3d direction, double solid_angle, double radiance) {
    const double distance = kSkyDistance * length(cameras_[0].forward);
    const auto at = [&](const kernel::Camera& camera) {
      const Vec3d center = camera.origin + direction * distance;
      return kernel::Sphere{center.x, center.y, center.z, distance * std::sqrt(solid_angle / std::numbers::pi)};
    };
    add(at(cameras_[0]), at(cameras_[1]), radiance);
  }

  /// The sums in all pixels.
  std::vector<EmitterCoverage> pixels() {
    std::vector<EmitterCoverage> out;
    if (corners_.empty()) return out;
    std::vector<Corner> above(static_cast<std::size_t>(width_));
    for (int y = 0; y < height_; ++y) {
      Corner row;
      for (int x = 0; x < width_; ++x) {
        row += corner(x, y);
        Corner& sum = above[static_cast<std::size_t>(x)] += row;
        out.push_back(sum.emitters());
      }
    }
    return out;
  }

 private:
  /// What is added to all pixels to the right and below. Rectangles consist of four, so large ones cost no more.
  struct Corner {
    double light = 0, square = 0;  ///< sums of coverage times radiance, and times its square
    Corner operator*(double factor) const { return {light * factor, square * factor}; }
    Corner& operator+=(const Corner& other) {
      light += other.light;
      square += other.square;
      return *this;
    }
    /// The number of hits of several emitters says nothing about a rare bright one among them. Of a sample, the
    /// relative variance is square / light^2, which is 1 / coverage for a single emitter.
    EmitterCoverage emitters() const {
      if (!(light > 0 && square > 0)) return {};
      return {static_cast<float>(std::min(light * light / square, 1.0)), static_cast<float>(light)};
    }
  };
  Corner& corner(double x, double y) {
    const auto column = static_cast<std::size_t>(std::clamp(x, 0.0, static_cast<double>(width_)));
    const auto row = static_cast<std::size_t>(std::clamp(y, 0.0, static_cast<double>(height_)));
    return corners_[row * static_cast<std::size_t>(width_ + 1) + column];
  }

  const kernel::SceneView& scene_;
  int width_, height_;  ///< px
  double margin_;       ///< px, by which the pixel filter extends beyond a pixel
  kernel::Camera cameras_[2] = {scene_.camera, closing_camera(scene_)};
  std::vector<Corner> corners_;
};

double mean_of(Vec3d rgb) { return (rgb.x + rgb.y + rgb.z) / 3; }

/// Adds the bright texels of a map.
void add_texels(const kernel::Environment& sky, Coverage& coverage) {
  const double columns = sky.width, rows = sky.height, turn = 2 * std::numbers::pi;
  const double threshold = kBrightTexel * sky.power / (2 * turn);
  const float* texel = sky.texels;
  for (std::uint32_t y = 0; y < sky.height; ++y) {
    const double colatitude = (y + 0.5) / rows * turn / 2, sine = math::sine(colatitude);
    for (std::uint32_t x = 0; x < sky.width; ++x, texel += 3) {
      const double radiance = sky.scale * mean_of({texel[0], texel[1], texel[2]});
      if (!(radiance > threshold)) continue;
      const double longitude = (0.5 + sky.turn - (x + 0.5) / columns) * turn;
      coverage.add_distant({sine * math::sine(longitude), math::cosine(colatitude), sine * math::cosine(longitude)},
                           turn / columns * turn / 2 / rows * sine, radiance);
    }
  }
}

}  // namespace

std::vector<EmitterCoverage> emitter_coverage(const kernel::SceneView& scene, int width_px, int height_px) {
  Coverage coverage(scene, width_px, height_px);
  for (std::size_t id = 0; scene.emission != nullptr && id < scene.sphere_count; ++id) {
    const double radiance = mean_of(math::vector_of(scene.emission[scene.object_materials[id]].radiance));
    if (!(radiance > 0)) continue;
    coverage.add(sphere_at(scene, id, 0), sphere_at(scene, id, 1), radiance,
                 scene.opacity != nullptr ? double{scene.opacity[id]} : 1);
  }
  const kernel::Environment* const sky = scene.environment;
  if (sky != nullptr && scene.background_visible && !scene.has_backdrop && !scene.camera.is_orthographic) {
    add_texels(*sky, coverage);
    if (sky->has_sun)
      coverage.add_distant(sky->sun, 2 * std::numbers::pi * sky->sun_one_minus_cos, mean_of(sky->sun_radiance));
  }
  return coverage.pixels();
}

}  // namespace orrery::render
