// SPDX-License-Identifier: Apache-2.0
#include "render/seen_emitters.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <iterator>
#include <numbers>
#include <optional>
#include <utility>

#include "compile/light_tree.h"
#include "kernel/seen_emitter_sample.h"
#include "math/pixels.h"
#include "math/vec3.h"

namespace orrery::render {
namespace {

using math::Vec3d;

/// Maximum number of pairs of a pixel and an emitter: 48 megabytes.
constexpr double kMostPairs = 1 << 22;

/// Emitters are sampled by points of the lens if its blur is at least this many times the sharp image; otherwise by
/// points of the film, if the area of the image is less than a pixel.
constexpr double kLeastRatio = 2;

/// Lower bound of the probability that a pixel is within an image that may touch it.
constexpr double kLeastShare = 0.05;

/// The image of an emitter.
struct Spot {
  std::uint32_t id;
  bool by_lens;
  kernel::FilmDisc disc;
  double reach;     ///< px, between its centre and that of a pixel that it may touch
  double radiance;  ///< that it adds to a pixel within
};

/// Empty if many of the camera rays of some pixel hit the emitter, or if it cannot be sampled.
std::optional<Spot> spot_of(const kernel::SceneView& scene, std::uint32_t id, double filter_margin) {
  const std::uint32_t material = scene.object_materials[id];
  const auto& [red, green, blue] = scene.emission[material].radiance;
  const bool is_textured =
      scene.material_textures != nullptr && scene.material_textures[material].radiance != kernel::kNone;
  const bool is_translucent = scene.opacity != nullptr && scene.opacity[id] < 1;
  if (!(red + green + blue > 0) || is_textured || is_translucent || id < scene.moving_count) return std::nullopt;
  const kernel::Sphere sphere = scene.spheres[id];
  const kernel::Camera& camera = scene.camera;
  const Vec3d to = Vec3d{sphere.x, sphere.y, sphere.z} - camera.origin;
  const double focus = length(camera.forward), z = dot(to, camera.forward) / focus, lens = length(camera.lens_u);
  if (!(z > 2 * sphere.radius && length(to) > sphere.radius + lens)) return std::nullopt;
  const double blur = lens * std::abs(1 - z / focus);              // at the emitter, as its radius
  const bool has_focus = std::abs(z - focus) < 2 * sphere.radius;  // some of its points may be in focus
  const bool by_lens = !has_focus && blur >= kLeastRatio * sphere.radius;
  const double pixel = length(camera.right) * length(camera.down) * (z / focus) * (z / focus);
  const double area = std::numbers::pi * sphere.radius * sphere.radius / pixel;
  if (!by_lens && !(area * std::pow(dot(to, to) / (z * z), 1.5) < 1)) return std::nullopt;
  const kernel::FilmDisc disc = film_disc(camera, sphere);
  const double radiance = (red + green + blue) / 3 * area / std::fmax(std::numbers::pi * blur * blur / pixel, 1);
  return Spot{id, by_lens, disc, disc.radius + std::numbers::sqrt2 * (0.5 + filter_margin), radiance};
}

/// The places of pixels along an axis, of `count`, whose centres are within a spot's bounds.
///
/// `middle`   of the frame, px from the edge of the window
struct PixelRange {
  int begin, end;
  PixelRange(double center, double reach, double middle, int count)
      : begin(static_cast<int>(std::clamp(std::ceil(center - reach + middle - 0.5), 0.0, static_cast<double>(count)))),
        end(static_cast<int>(std::clamp(std::floor(center + reach + middle + 0.5), 0.0, static_cast<double>(count)))) {}
};

/// Calls `what(pixel, share)` for each pixel that a spot may touch, with an estimate of the radiance that it adds.
template <class What>
void each_pixel(const Spot& spot, const kernel::Camera& camera, int width_px, int height_px, What what) {
  const PixelRange columns(spot.disc.x, spot.reach, camera.half_width, width_px),
      rows(spot.disc.y, spot.reach, camera.half_height, height_px);
  for (int y = rows.begin; y < rows.end; ++y)
    for (int x = columns.begin; x < columns.end; ++x) {
      const double dx = x + 0.5 - camera.half_width - spot.disc.x, dy = y + 0.5 - camera.half_height - spot.disc.y;
      const double distance = std::sqrt(dx * dx + dy * dy);
      if (distance > spot.reach) continue;
      what(math::pixel_index(x, y, width_px),
           spot.radiance * std::clamp(spot.disc.radius + 0.5 - distance, kLeastShare, 1.0));
    }
}

bool can_sample(const kernel::SceneView& scene, kernel::Precision precision) {
  return scene.emission != nullptr && scene.direct_lighting != kernel::DirectLighting::kBsdf &&
         scene.shading == kernel::Shading::kPath && !scene.camera.is_orthographic && !scene.features.depth_cue &&
         scene.page == kernel::kNone && precision != kernel::Precision::kBook && !camera_moves(scene);
}

/// Number of pixels that an image may touch.
double pixels_of(const Spot& spot) { return std::numbers::pi * spot.reach * spot.reach; }

/// The images of the emitters that are sampled, by ascending id.
std::vector<Spot> find_spots(const kernel::SceneView& scene, kernel::Precision precision) {
  std::vector<Spot> spots;
  if (!can_sample(scene, precision)) return spots;
  const double filter_margin =
      scene.filter.places != nullptr ? scene.filter.places[kernel::PixelFilter::kSteps] - 0.5 : 0;
  std::vector<std::uint32_t> ids;
  for (std::uint32_t id = 0; id < scene.sphere_count; ++id)
    if (const auto spot = spot_of(scene, id, filter_margin)) {
      spots.push_back(*spot);
      ids.push_back(id);
    }
  ids = compile::without_coincident(scene, precision, std::move(ids));
  std::erase_if(spots, [&](const Spot& spot) { return !std::ranges::binary_search(ids, spot.id); });
  double sum = 0;
  for (const Spot& spot : spots) sum += pixels_of(spot);
  if (sum > kMostPairs) {
    std::ranges::stable_sort(spots, std::greater(), &Spot::radiance);
    sum = 0;
    std::erase_if(spots, [&](const Spot& spot) { return (sum += pixels_of(spot)) > kMostPairs; });
    std::ranges::sort(spots, {}, &Spot::id);
  }
  return spots;
}

}  // namespace

bool camera_moves(const kernel::SceneView& scene) {
  return scene.features.motion && std::any_of(std::begin(kernel::kCameraVectors), std::end(kernel::kCameraVectors),
                                              [&](auto vector) { return scene.camera_motion.*vector != Vec3d{}; });
}

std::uint64_t SeenEmitterList::bytes_of_build(const kernel::SceneView& scene, kernel::Precision precision, int width_px,
                                              int height_px) {
  const std::vector<Spot> spots = find_spots(scene, precision);
  if (spots.empty()) return 0;
  double pairs = 0;
  for (const Spot& spot : spots) pairs += pixels_of(spot);
  return static_cast<std::uint64_t>(pairs * sizeof(kernel::SeenEmitter)) + spots.size() * sizeof(Spot) +
         math::pixel_count(width_px, height_px) * 2 * sizeof(std::uint32_t);
}

SeenEmitterList::SeenEmitterList(const kernel::SceneView& scene, kernel::Precision precision, int width_px,
                                 int height_px) {
  const std::vector<Spot> spots = find_spots(scene, precision);
  if (spots.empty()) return;

  for (const Spot& spot : spots) ids_.push_back(spot.id);
  begins_.assign(math::pixel_count(width_px, height_px) + 1, 0);
  const auto each = [&](auto what) {
    for (const Spot& spot : spots)
      each_pixel(spot, scene.camera, width_px, height_px,
                 [&](std::size_t pixel, double light) { what(spot, pixel, light); });
  };
  each([&](const Spot&, std::size_t pixel, double) { ++begins_[pixel + 1]; });
  for (std::size_t i = 1; i < begins_.size(); ++i) begins_[i] += begins_[i - 1];
  emitters_.resize(begins_.back());
  width_ = width_px;
  std::vector<std::uint32_t> next(begins_.begin(), begins_.end() - 1);
  each([&](const Spot& spot, std::size_t pixel, double light) {
    emitters_[next[pixel]++] = {spot.id, static_cast<float>(light), spot.by_lens};
  });
  for (std::size_t i = 0; i + 1 < begins_.size(); ++i) {
    double total = 0, part = 0;
    for (std::uint32_t k = begins_[i]; k < begins_[i + 1]; ++k) total += double{emitters_[k].share_end};
    for (std::uint32_t k = begins_[i]; k < begins_[i + 1]; ++k) {
      part += double{emitters_[k].share_end};
      emitters_[k].share_end = k + 1 < begins_[i + 1] ? static_cast<float>(part / total) : 1.0f;
    }
  }
}

}  // namespace orrery::render
