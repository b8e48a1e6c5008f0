// SPDX-License-Identifier: Apache-2.0
#include "render/small_emitters.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "kernel/scene_view.h"
#include "math/vec3.h"

namespace orrery::render {
namespace {

using math::Vec3d;
using math::vector_of;

/// Side of the largest image of a small emitter, px, without the pixel filter. Larger ones are found through the
/// neighbours.
constexpr int kLargestSide = 3;

/// The distance of the sun of a daylight sky, in distances to the focus plane. The result does not depend on it as long
/// as it is large.
constexpr double kSunDistance = 0x1p40;

/// The camera at the time when the shutter opens (0) or closes (1).
kernel::Camera camera_at(const kernel::SceneView& scene, int time) {
  kernel::Camera out = scene.camera;
  if (time == 0 || !scene.features.motion) return out;
  const kernel::Camera& change = scene.camera_motion;
  for (int k = 0; k < 3; ++k) {
    out.origin[k] += change.origin[k];
    out.forward[k] += change.forward[k];
    out.right[k] += change.right[k];
    out.down[k] += change.down[k];
    out.lens_u[k] += change.lens_u[k];
    out.lens_v[k] += change.lens_v[k];
  }
  return out;
}

/// The image of a sphere: a rectangle around it, and its area without the blur of the lens.
struct SphereImage {
  double x0, x1, y0, y1;  ///< px, relative to the rendered window
  double area;            ///< square pixels
};

/// Projects a sphere. Empty if the sphere is behind the camera or contains it.
std::optional<SphereImage> image_of(const kernel::Camera& camera, Vec3d center, double radius) {
  const Vec3d forward = vector_of(camera.forward), right = vector_of(camera.right), down = vector_of(camera.down);
  const Vec3d to = center - vector_of(camera.origin), across = cross(right, down);
  const double determinant = dot(forward, across);
  const double depth = dot(to, across) / determinant;  // 1 at the focus plane
  if (!(depth * length(forward) > radius)) return std::nullopt;
  const double scale = camera.is_orthographic ? 1 : depth;
  const double x = dot(to, cross(down, forward)) / (determinant * scale) + camera.half_width;
  const double y = dot(to, cross(forward, right)) / (determinant * scale) + camera.half_height;
  const double pixel_width = scale * length(right), pixel_height = scale * length(down);  // at the sphere
  const double blurred = radius + length(vector_of(camera.lens_u)) * std::abs(1 - depth);
  return SphereImage{x - blurred / pixel_width, x + blurred / pixel_width, y - blurred / pixel_height,
                     y + blurred / pixel_height, std::numbers::pi * radius * radius / (pixel_width * pixel_height)};
}

/// Adds up the images of emitters.
class Coverage {
 public:
  Coverage(const kernel::SceneView& scene, int width_px, int height_px)
      : width_(width_px),
        height_(height_px),
        margin_(scene.filter.above != nullptr ? scene.filter.above[kernel::PixelFilter::kSteps] - 0.5 : 0) {}

  /// `opening`, `closing`  images when the shutter opens and closes
  /// `radiance`            mean of the channels
  void add(const std::optional<SphereImage>& opening, const std::optional<SphereImage>& closing, double radiance,
           double opacity = 1) {
    if (!opening || !closing) return;
    const double x0 = std::min(opening->x0, closing->x0), x1 = std::max(opening->x1, closing->x1);
    const double y0 = std::min(opening->y0, closing->y0), y1 = std::max(opening->y1, closing->y1);
    if (!(std::floor(x1) - std::floor(x0) < kLargestSide && std::floor(y1) - std::floor(y0) < kLargestSide)) return;
    const double left = std::floor(x0 - margin_), right = std::floor(x1 + margin_);
    const double top = std::floor(y0 - margin_), bottom = std::floor(y1 + margin_);
    if (!(right >= 0 && left < width_ && bottom >= 0 && top < height_)) return;
    const double share = opacity * (opening->area + closing->area) / 2 / ((right - left + 1) * (bottom - top + 1));
    if (pixels_.empty()) pixels_.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
    for (int y = std::max(static_cast<int>(top), 0); y <= std::min(static_cast<int>(bottom), height_ - 1); ++y) {
      for (int x = std::max(static_cast<int>(left), 0); x <= std::min(static_cast<int>(right), width_ - 1); ++x) {
        EmitterCoverage& pixel =
            pixels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)];
        pixel.coverage += static_cast<float>(share);
        pixel.light += static_cast<float>(share * radiance);
      }
    }
  }

  std::vector<EmitterCoverage> take() { return std::move(pixels_); }

 private:
  int width_, height_;  ///< px
  double margin_;       ///< px, by which the pixel filter extends beyond a pixel
  std::vector<EmitterCoverage> pixels_;
};

double mean_of(Vec3d rgb) { return (rgb.x + rgb.y + rgb.z) / 3; }

}  // namespace

std::vector<EmitterCoverage> find_small_emitters(const kernel::SceneView& scene, int width_px, int height_px) {
  Coverage coverage(scene, width_px, height_px);
  const kernel::Camera opening = camera_at(scene, 0), closing = camera_at(scene, 1);
  for (std::size_t id = 0; scene.emission != nullptr && id < scene.sphere_count; ++id) {
    const double radiance = mean_of(vector_of(scene.emission[scene.sphere_materials[id]].radiance));
    if (!(radiance > 0)) continue;
    const kernel::Sphere a = sphere_at(scene, id, 0), b = sphere_at(scene, id, 1);
    coverage.add(image_of(opening, {a.x, a.y, a.z}, a.radius), image_of(closing, {b.x, b.y, b.z}, b.radius), radiance,
                 scene.opacity != nullptr ? double{scene.opacity[id]} : 1);
  }
  const kernel::Environment* const sky = scene.environment;
  if (sky != nullptr && sky->has_sun && scene.background_visible && !scene.has_backdrop && !opening.is_orthographic) {
    const double distance = kSunDistance * length(vector_of(opening.forward));
    const double radius = distance * std::sqrt(2 * sky->sun_one_minus_cos);
    const auto image = [&](const kernel::Camera& camera) {
      return image_of(camera, vector_of(camera.origin) + sky->sun * distance, radius);
    };
    coverage.add(image(opening), image(closing), mean_of(sky->sun_radiance));
  }
  return coverage.take();
}

}  // namespace orrery::render
