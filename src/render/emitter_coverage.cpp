// SPDX-License-Identifier: Apache-2.0
#include "render/emitter_coverage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <vector>

#include "base/stop_point.h"
#include "base/zero_pages.h"
#include "kernel/ray_packet.h"
#include "kernel/scene_view.h"
#include "math/pixels.h"
#include "math/scalar.h"
#include "math/vec3.h"
#include "render/reflections.h"
#include "render/sphere_images.h"

namespace orrery::render {
namespace {

using math::Vec3d;

/// Emitters that cover more of each pixel are found by the first samples.
constexpr double kLargestCoverage = 0.5;

/// Texels of a map count as emitters if they are brighter than its mean by this factor.
constexpr double kBrightTexel = 8;

/// The sphere at a share of the way from one to another of the same radius.
kernel::Sphere mixed(const kernel::Sphere& from, const kernel::Sphere& to, double share) {
  return sphere_around(center_of(from) * (1 - share) + center_of(to) * share, from.radius);
}

/// The camera when the shutter closes.
kernel::Camera closing_camera(const kernel::SceneView& scene) {
  kernel::Camera out = scene.camera;
  if (!scene.features.motion) return out;
  for (const auto vector : kernel::kCameraVectors) out.*vector = out.*vector + scene.camera_motion.*vector;
  return out;
}

using MovingImage = Moving<std::optional<SphereImage>>;

/// A line of sight from the camera, or from a sphere. It may touch what it starts from and what it leads to.
struct Sightline {
  Vec3d center, offset;  ///< of the sphere, and from there to the start
  Vec3d to;              ///< from the start to the end
  std::uint32_t from, target;
  double time;
};
constexpr int kSightlines = kernel::kPacketSize;
using Sightlines = std::array<Sightline, kSightlines>;

/// Returns a bit for each line that nothing blocks.
template <class T>
std::uint32_t free_lines(const kernel::Tracer& tracer, const Sightlines& lines) {
  kernel::ShadowPacket<T> packet{};
  packet.count = kSightlines;
  for (int i = 0; i < kSightlines; ++i) {
    const Sightline& line = lines[static_cast<std::size_t>(i)];
    const double away = length(line.to);
    const double from[3] = {line.center.x, line.center.y, line.center.z},
                 offset[3] = {line.offset.x, line.offset.y, line.offset.z},
                 direction[3] = {line.to.x / away, line.to.y / away, line.to.z / away};
    for (int k = 0; k < 3; ++k) {
      packet.offset[k][i] = static_cast<T>(offset[k]);
      packet.origin[k][i] = static_cast<T>(from[k]) + packet.offset[k][i];
      packet.origin_low[k][i] = packet.offset[k][i] - (packet.origin[k][i] - static_cast<T>(from[k]));
      packet.direction[k][i] = static_cast<T>(direction[k]);
    }
    packet.inverse_square[i] = 1;
    packet.distance[i] = static_cast<T>(away);
    packet.self[i] = line.from;
    packet.target[i] = line.target;
    packet.time[i] = static_cast<T>(line.time);
    // Thresholds differ, so that some lines pass translucent objects.
    packet.threshold[i] = static_cast<float>(i * 5 % kSightlines) / kSightlines;
  }
  kernel::occlude(tracer, packet);
  std::uint32_t out = 0;
  for (int i = 0; i < kSightlines; ++i) out |= packet.occluded[i] == 0 ? 1U << i : 0U;
  return out;
}

/// Points on the unit disc, of about even density.
std::array<std::array<double, 2>, kSightlines> disc_points() {
  std::array<std::array<double, 2>, kSightlines> out{};
  for (int i = 0; i < kSightlines; ++i) {
    const double radius = std::sqrt((i + 0.5) / kSightlines), angle = i * std::numbers::pi * (3 - std::sqrt(5.0));
    out[static_cast<std::size_t>(i)] = {radius * math::cosine(angle), radius * math::sine(angle)};
  }
  return out;
}

/// Adds up the images of emitters.
class Coverage {
 public:
  Coverage(const kernel::SceneView& scene, const Visibility& visibility, int width_px, int height_px)
      : scene_(scene),
        visibility_(visibility),
        width_(width_px),
        height_(height_px),
        margin_(scene.filter.places != nullptr ? scene.filter.places[kernel::PixelFilter::kSteps] - 0.5 : 0) {}

  MovingImage images_of(const Moving<kernel::Sphere>& sphere) const {
    return {sphere_image(cameras_[0], sphere[0]), sphere_image(cameras_[1], sphere[1])};
  }

  /// Whether images touch a pixel.
  bool is_seen(const MovingImage& images) const {
    const Rectangle r = rectangle_of(images);
    return r.right > 0 && r.left < width_ && r.bottom > 0 && r.top < height_;
  }

  /// Adds a light, unless it is hidden.
  ///
  /// `id`        of the object; kNone: it is in the sky
  /// `radiance`  mean of the channels
  void add(const Moving<kernel::Sphere>& light, std::uint32_t id, double radiance, double opacity = 1) {
    const MovingImage images = images_of(light);
    add(images, radiance, opacity, [&] { return free_lines(sightlines(light, id)) != 0; });
  }

  /// Adds half of a rod, in parts of about a pixel: a rectangle around all of it would consist of other pixels.
  ///
  /// `from`      its middle
  void add_half_rod(const Moving<kernel::Sphere>& from, const Moving<kernel::Sphere>& to, std::uint32_t id,
                    double radiance, double opacity) {
    constexpr double kMostParts = 4096;
    const MovingImage a = images_of(from), b = images_of(to);
    double parts = 1;
    for (int k = 0; k < 2; ++k) parts = std::max(parts, a[k] && b[k] ? std::ceil(distance(*a[k], *b[k])) : kMostParts);
    parts = std::min(parts, kMostParts);
    const double cap = 1 / parts;  // its whole disc is seen along the axis
    MovingImage last = a;
    for (double i = 1; i <= parts; ++i) {
      const auto at = [&](double share) {
        return Moving<kernel::Sphere>{mixed(from[0], to[0], share), mixed(from[1], to[1], share)};
      };
      const MovingImage next = images_of(at(i / parts));
      add({between(last[0], next[0], cap), between(last[1], next[1], cap)}, radiance, opacity,
          [&] { return free_lines(sightlines(at((i - 0.5) / parts), id)) != 0; });
      last = next;
    }
  }

  /// Adds the reflection of a light.
  ///
  /// `ball_area`    of the ball's image, square pixels
  void add_reflection(const ReflectedLight& from, const Moving<kernel::Sphere>& ball, double ball_area,
                      std::uint32_t ball_id) {
    const Moving<kernel::Sphere>& light = from.sphere;
    if (brightest_reflection(from, ball[0], ball_area) < kLeastLight) return;
    const int steps = reflection_steps(ball_area);
    MovingImage images;
    Moving<kernel::Sphere> points;
    double reflected = 0;
    for (int k = 0; k < 2; ++k) {
      const auto seen = reflection_of(light[k], ball[k], eye(k, center_of(ball[k])), steps);
      if (!seen) return;
      images[k] = sphere_image(cameras_[k], seen->image);
      points[k] = sphere_around(center_of(ball[k]) + seen->point, 0);
      reflected += from.radiance * sharp_reflectance(scene_, ball_id, seen->cosine) / 2;
    }
    add(images, reflected, 1, [&] {
      const Sightlines to_ball = sightlines(points, ball_id);
      Sightlines to_light = sightlines(light, from.id);
      for (std::size_t i = 0; i < to_light.size(); ++i) {
        Sightline& line = to_light[i];
        const kernel::Sphere at = mixed(points[0], points[1], line.time);
        line.to = line.center + line.offset + line.to - center_of(at);
        line.center = center_of(mixed(ball[0], ball[1], line.time));
        line.offset = center_of(at) - line.center;
        line.from = ball_id;
      }
      return (free_lines(to_ball) & free_lines(to_light)) != 0;
    });
  }

  /// An emitter as far away as the sky, as a sphere.
  ///
  /// `direction`  unit
  Moving<kernel::Sphere> distant(Vec3d direction, double solid_angle) const {
    return {distant_sphere(cameras_[0], direction, solid_angle), distant_sphere(cameras_[1], direction, solid_angle)};
  }

  /// The sums in all pixels.
  std::vector<EmitterCoverage> pixels() {
    std::vector<EmitterCoverage> out;
    if (corners_.empty()) return out;
    out.reserve(math::pixel_count(width_, height_));
    std::vector<Corner> above(static_cast<std::size_t>(width_));
    const base::StopPoint stop;
    for (int y = 0; y < height_; ++y) {
      stop.check();
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
  /// Adds images of a light.
  ///
  /// `is_visible`  called if they are in the frame, and small
  template <class IsVisible>
  void add(const MovingImage& images, double radiance, double opacity, IsVisible is_visible) {
    if (!is_seen(images)) return;
    const Rectangle r = rectangle_of(images);
    const double coverage =
        opacity * (images[0]->area + images[1]->area) / 2 / ((r.right - r.left) * (r.bottom - r.top));
    if (!(coverage < kLargestCoverage && coverage * radiance >= kLeastLight) || !is_visible()) return;
    corners_.resize(static_cast<std::size_t>(width_ + 1) * static_cast<std::size_t>(height_ + 1));
    for (const double x : {r.left, r.right})
      for (const double y : {r.top, r.bottom})
        corner(x, y) +=
            Corner{coverage * radiance, coverage * radiance * radiance} * ((x == r.left) == (y == r.top) ? 1 : -1);
  }

  /// Lines from points of the lens, and of the film of an orthographic camera, to points of a light.
  Sightlines sightlines(const Moving<kernel::Sphere>& light, std::uint32_t id) const {
    Sightlines out;
    for (std::size_t i = 0; i < out.size(); ++i) {
      const double time = (static_cast<double>(i) + 0.5) / kSightlines;
      const auto at_time = [&](Vec3d kernel::Camera::*vector) {
        return cameras_[0].*vector * (1 - time) + cameras_[1].*vector * time;
      };
      const Vec3d center = center_of(mixed(light[0], light[1], time)), right = at_time(&kernel::Camera::right),
                  down = at_time(&kernel::Camera::down), forward = at_time(&kernel::Camera::forward);
      Sightline& line = out[i];
      line.center = at_time(&kernel::Camera::origin);
      line.offset = at_time(&kernel::Camera::lens_u) * disc_[i][0] + at_time(&kernel::Camera::lens_v) * disc_[i][1];
      if (scene_.camera.is_orthographic) {
        const Vec3d to = center - line.center;
        line.offset = line.offset + to - forward * (dot(to, forward) / dot(forward, forward));
      }
      const auto& [x, y] = disc_[(5 * i + 3) % kSightlines];
      const Vec3d across = normalized(right) * (x * light[0].radius) + normalized(down) * (y * light[0].radius);
      line.to = center + across - (line.center + line.offset);
      line.from = kernel::kCamera;
      line.target = id;
      line.time = time;
    }
    return out;
  }

  std::uint32_t free_lines(const Sightlines& lines) const {
    return visibility_.precision == kernel::Precision::kFast ? render::free_lines<float>(visibility_.tracer, lines)
                                                             : render::free_lines<double>(visibility_.tracer, lines);
  }

  /// Whole pixels.
  struct Rectangle {
    double left = 0, right = 0, top = 0, bottom = 0;
  };
  /// The pixels around images; none if one is missing.
  Rectangle rectangle_of(const MovingImage& images) const {
    const auto &a = images[0], &b = images[1];
    if (!a || !b) return {};
    return {std::floor(std::min(a->x0, b->x0) - margin_), std::floor(std::max(a->x1, b->x1) + margin_) + 1,
            std::floor(std::min(a->y0, b->y0) - margin_), std::floor(std::max(a->y1, b->y1) + margin_) + 1};
  }

  /// The point from which a camera sees another one.
  Vec3d eye(int k, Vec3d at) const {
    const kernel::Camera& camera = cameras_[k];
    return camera.is_orthographic ? at - camera.forward * kSkyDistance : camera.origin;
  }

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
  const Visibility& visibility_;
  const std::array<std::array<double, 2>, kSightlines> disc_ = disc_points();
  int width_, height_;  ///< px
  double margin_;       ///< px, by which the pixel filter extends beyond a pixel
  kernel::Camera cameras_[2] = {scene_.camera, closing_camera(scene_)};
  base::ZeroVector<Corner> corners_;
};

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
      const Vec3d direction = {sine * math::sine(longitude), math::cosine(colatitude), sine * math::cosine(longitude)};
      coverage.add(coverage.distant(direction, turn / columns * turn / 2 / rows * sine), kernel::kNone, radiance);
    }
  }
}

/// Adds half of a rod that emits.
void add_half_rod(const kernel::SceneView& scene, std::uint32_t id, double radiance, Coverage& coverage) {
  const std::size_t i = scene.rods.index(id);
  Moving<kernel::Sphere> from, to;
  for (const std::size_t k : {0U, 1U}) {
    const kernel::Rod rod = scene.rods.at(i, static_cast<double>(k));
    from[k] = sphere_around((math::vector_of(rod.a) + math::vector_of(rod.b)) / 2, rod.radius);
    to[k] = sphere_around(math::vector_of(id == scene.rods.id(i) ? rod.a : rod.b), rod.radius);
  }
  coverage.add_half_rod(from, to, id, radiance, opacity_of(scene, id));
}

/// Adds spheres and rods that emit, except those that are sampled. Of spheres that coincide, only the first is visible.
void add_emitters(const kernel::SceneView& scene, Coverage& coverage) {
  const auto end = static_cast<std::uint32_t>(scene.sphere_count + 2 * scene.rods.count);
  for (std::uint32_t id = 0; id < end; ++id) {
    const double radiance = radiance_of(scene, id);
    if (!(radiance > 0) || scene.seen_emitters.has({kernel::kCamera, id})) continue;
    if (scene.rods.contains(id))
      add_half_rod(scene, id, radiance, coverage);
    else
      coverage.add(moving_sphere(scene, id), id, radiance, opacity_of(scene, id));
  }
}

/// Adds what balls reflect, except what is sampled.
void add_reflections(const kernel::SceneView& scene, Coverage& coverage) {
  const auto lights = reflected_lights(scene, count_sharp_balls(scene));
  for (std::uint32_t id = 0; !lights.empty() && id < scene.sphere_count; ++id) {
    if (!is_sharp(scene, id)) continue;
    const auto ball = moving_sphere(scene, id);
    const MovingImage images = coverage.images_of(ball);
    if (!coverage.is_seen(images)) continue;
    const double area = std::max(images[0]->area, images[1]->area);
    for (const ReflectedLight& light : lights)
      if (!scene.seen_emitters.has({id, light.id})) coverage.add_reflection(light, ball, area, id);
  }
}

}  // namespace

std::vector<EmitterCoverage> emitter_coverage(const kernel::SceneView& scene, const Visibility& visibility,
                                              int width_px, int height_px) {
  Coverage coverage(scene, visibility, width_px, height_px);
  if (scene.emission != nullptr) add_emitters(scene, coverage);
  if (scene.features.lit) add_reflections(scene, coverage);
  const kernel::Environment* const sky = scene.environment;
  if (sky != nullptr && scene.background_visible && !scene.has_backdrop && !scene.camera.is_orthographic) {
    add_texels(*sky, coverage);
    if (sky->has_sun)
      coverage.add(coverage.distant(sky->sun, 2 * std::numbers::pi * sky->sun_one_minus_cos), kernel::kNone,
                   mean_of(sky->sun_radiance));
  }
  return coverage.pixels();
}

}  // namespace orrery::render
