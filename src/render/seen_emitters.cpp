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

#include "kernel/seen_emitter_sample.h"
#include "math/pixels.h"
#include "math/vec3.h"
#include "render/reflections.h"
#include "render/sphere_images.h"

namespace orrery::render {
namespace {

using math::Vec3d;

/// Maximum number of pairs of a pixel and an emitter: 64 megabytes.
constexpr double kMostPairs = 1 << 22;

/// Emitters are sampled by points of the lens if its blur is at least this many times the sharp image; otherwise by
/// points of the film, if the area of the image is less than a pixel.
constexpr double kLeastRatio = 2;

/// Images in balls are sampled by points of the film, if their area and that of the lens's blur are below these, px.
constexpr double kLargestGlint = 0.25, kLargestBlur = 4;

/// Lower bound of the probability that a pixel is within an image that may touch it.
constexpr double kLeastShare = 0.05;

/// The image of an emitter.
struct Spot {
  kernel::Sight sight;
  bool by_lens;
  kernel::FilmDisc disc;
  double reach;     ///< px, between its centre and that of a pixel that it may touch
  double radiance;  ///< that it adds to a pixel within
};

/// How large the camera sees a sphere.
struct Appearance {
  double depth;  ///< along the view axis, scene units
  double pixel;  ///< area of a pixel at the sphere, square scene units
  double blur;   ///< of the lens, radius at the sphere, scene units
  double area;   ///< of the sharp image, px

  Appearance(const kernel::Camera& camera, const kernel::Sphere& sphere) {
    const double focus = length(camera.forward);
    depth = dot(center_of(sphere) - camera.origin, camera.forward) / focus;
    pixel = length(camera.right) * length(camera.down) * (depth / focus) * (depth / focus);
    blur = length(camera.lens_u) * std::abs(1 - depth / focus);
    area = std::numbers::pi * sphere.radius * sphere.radius / pixel;
  }
  double blur_area() const { return std::numbers::pi * blur * blur / pixel; }

  /// Its image, if an emitter of a radiance, mean of the channels, appears so.
  Spot spot(kernel::Sight sight, bool by_lens, const kernel::FilmDisc& disc, double radiance,
            double filter_margin) const {
    return {sight, by_lens, disc, disc.radius + std::numbers::sqrt2 * (0.5 + filter_margin),
            radiance * area / std::fmax(blur_area(), 1)};
  }
};

/// Whether an object is at rest, and opaque.
bool is_plain(const kernel::SceneView& scene, std::uint32_t id) {
  return id >= scene.moving_count && opacity_of(scene, id) >= 1;
}

bool has_texture(const kernel::SceneView& scene, std::uint32_t id, std::uint32_t kernel::MaterialTextures::*of) {
  return scene.material_textures != nullptr && scene.material_textures[scene.object_materials[id]].*of != kernel::kNone;
}

/// Whether the emission of an object is known in advance.
bool is_plain_emitter(const kernel::SceneView& scene, std::uint32_t id) {
  return is_plain(scene, id) && radiance_of(scene, id) > 0 &&
         !has_texture(scene, id, &kernel::MaterialTextures::radiance);
}

/// Empty if many of the camera rays of some pixel hit the emitter, or if it cannot be sampled.
std::optional<Spot> spot_of(const kernel::SceneView& scene, std::uint32_t id, double filter_margin) {
  if (!is_plain_emitter(scene, id)) return std::nullopt;
  const kernel::Sphere sphere = scene.spheres[id];
  const kernel::Camera& camera = scene.camera;
  const Vec3d to = center_of(sphere) - camera.origin;
  const Appearance seen(camera, sphere);
  const double z = seen.depth;
  if (!(z > 2 * sphere.radius && length(to) > sphere.radius + length(camera.lens_u))) return std::nullopt;
  const bool has_focus =
      std::abs(z - length(camera.forward)) < 2 * sphere.radius;  // some of its points may be in focus
  const bool by_lens = !has_focus && seen.blur >= kLeastRatio * sphere.radius;
  if (!by_lens && !(seen.area * std::pow(dot(to, to) / (z * z), 1.5) < 1)) return std::nullopt;
  return seen.spot({.emitter = id}, by_lens, film_disc(camera, sphere), radiance_of(scene, id), filter_margin);
}

/// Adds the small images in a ball.
void add_glints(const kernel::SceneView& scene, std::uint32_t ball, const std::vector<ReflectedLight>& lights,
                double filter_margin, std::vector<Spot>& to) {
  const kernel::Sphere mirror = scene.spheres[ball];
  const kernel::Camera& camera = scene.camera;
  const bool is_clear = length(center_of(mirror) - camera.origin) > mirror.radius + length(camera.lens_u);
  const auto image = sphere_image(camera, mirror);
  if (!is_clear || !image || !is_plain(scene, ball) || has_texture(scene, ball, &kernel::MaterialTextures::albedo))
    return;
  for (const ReflectedLight& light : lights) {
    if (brightest_reflection(light, mirror, image->area) < kLeastLight) continue;
    const auto found = reflection_of(light.sphere[0], mirror, camera.origin, reflection_steps(image->area));
    if (!found) continue;
    const Appearance seen(camera, found->image);
    if (!(seen.depth > 2 * found->image.radius && seen.area < kLargestGlint && seen.blur_area() < kLargestBlur))
      continue;
    // Images in a ball are astigmatic: wider across the plane of incidence, by 1 / cos^2 if the light is far away.
    kernel::FilmDisc disc = film_disc(camera, found->image);
    disc.radius /= std::fmax(found->cosine, 0.1);
    to.push_back(seen.spot({ball, light.id}, false, disc,
                           light.radiance * sharp_reflectance(scene, ball, found->cosine), filter_margin));
  }
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
  return scene.features.lit && scene.direct_lighting != kernel::DirectLighting::kBsdf &&
         scene.shading == kernel::Shading::kPath && !scene.camera.is_orthographic && !scene.features.depth_cue &&
         scene.page == kernel::kNone && precision != kernel::Precision::kBook && !camera_moves(scene);
}

/// Number of pixels that an image may touch.
double pixels_of(const Spot& spot) { return std::numbers::pi * spot.reach * spot.reach; }

/// The images of the emitters that are sampled, by ascending key of their sights.
std::vector<Spot> find_spots(const kernel::SceneView& scene, kernel::Precision precision) {
  std::vector<Spot> spots;
  if (!can_sample(scene, precision)) return spots;
  const double filter_margin =
      scene.filter.places != nullptr ? scene.filter.places[kernel::PixelFilter::kSteps] - 0.5 : 0;
  for (std::uint32_t id = 0; scene.emission != nullptr && id < scene.sphere_count; ++id)
    if (const auto spot = spot_of(scene, id, filter_margin); spot && !scene.is_duplicate(id)) spots.push_back(*spot);
  if (precision == kernel::Precision::kExact && scene.max_depth > 1) {
    const std::size_t balls = count_sharp_balls(scene);
    auto lights = reflected_lights(scene, balls <= kMostReflections ? balls : 0);
    std::erase_if(lights, [&](const ReflectedLight& light) {
      return light.id != kernel::kSun && !is_plain_emitter(scene, light.id);
    });
    for (std::uint32_t id = 0; !lights.empty() && id < scene.sphere_count; ++id)
      if (is_sharp(scene, id)) add_glints(scene, id, lights, filter_margin, spots);
  }
  double sum = 0;
  for (const Spot& spot : spots) sum += pixels_of(spot);
  if (sum > kMostPairs) {
    std::ranges::stable_sort(spots, std::greater(), &Spot::radiance);
    sum = 0;
    std::erase_if(spots, [&](const Spot& spot) { return (sum += pixels_of(spot)) > kMostPairs; });
  }
  std::ranges::sort(spots, {}, [](const Spot& spot) { return spot.sight.key(); });
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

  for (const Spot& spot : spots) sights_.push_back(spot.sight);
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
    emitters_[next[pixel]++] = {spot.sight.emitter, static_cast<float>(light), spot.by_lens, spot.sight.ball};
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
