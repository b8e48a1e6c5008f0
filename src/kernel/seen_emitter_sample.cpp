// SPDX-License-Identifier: Apache-2.0
#include "kernel/seen_emitter_sample.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "kernel/scene_view.h"

namespace orrery::kernel {
namespace {

using math::Vec3d;

/// A plane with two perpendicular axes.
struct Plane {
  Vec3d origin, s, t;
};

struct Interval {
  double low, high;
  double width() const { return high - low; }
  double at(double share) const { return low + width() * share; }
};

/// The points (s, t) of a plane with ss ds^2 + 2 st ds dt + tt dt^2 <= square, relative to the centre.
struct Ellipse {
  double s, t;  ///< centre
  double ss, st, tt, square;
  double determinant = ss * tt - st * st;

  double area() const { return std::numbers::pi * square / std::sqrt(determinant); }
  double half_s() const { return std::sqrt(square * tt / determinant); }
  bool contains(double at_s, double at_t) const {
    const double ds = at_s - s, dt = at_t - t;
    return ss * ds * ds + 2 * st * ds * dt + tt * dt * dt <= square;
  }
  Ellipse swapped() const { return {t, s, tt, st, ss, square}; }

  /// The bounds in s of its part within bounds of s and t. Empty if low > high.
  Interval bounds_s(Interval within_s, Interval within_t) const {
    const auto end = [&](double sign) {
      const double dt = std::clamp(-sign * st / tt * half_s(), within_t.low - t, within_t.high - t);
      const double root = square / ss - determinant / (ss * ss) * dt * dt;
      return root >= 0 ? s - st / ss * dt + sign * std::sqrt(root) : -sign * HUGE_VAL;
    };
    return {std::fmax(end(-1), within_s.low), std::fmin(end(1), within_s.high)};
  }
};

/// The points of a plane whose lines to an apex hit a sphere.
///
/// `to`       from the apex to the sphere's centre
/// Domain     the apex is outside of the sphere; the plane through it that is parallel to `plane` does not touch it
/// Precision  relative to the line to the centre, without cancellation for distant spheres
Ellipse section(const Plane& plane, Vec3d apex, Vec3d to, double radius) {
  const Vec3d normal = cross(plane.s, plane.t);
  const Vec3d axis = to * (dot(plane.origin - apex, normal) / dot(to, normal));  // from the apex to the plane
  const Vec3d at = apex + axis - plane.origin;
  const double square_s = dot(plane.s, plane.s), square_t = dot(plane.t, plane.t), r2 = radius * radius;
  // The line to axis + e hits the sphere if |to x e|^2 <= r^2 |axis + e|^2.
  const double along_s = dot(to, plane.s), along_t = dot(to, plane.t), beyond = dot(to, to) - r2;
  const double ss = beyond * square_s - along_s * along_s, st = -along_s * along_t,
               tt = beyond * square_t - along_t * along_t;
  const double s = r2 * dot(axis, plane.s), t = r2 * dot(axis, plane.t), determinant = ss * tt - st * st;
  const double ds = (s * tt - t * st) / determinant, dt = (t * ss - s * st) / determinant;
  return {dot(at, plane.s) / square_s + ds,      dot(at, plane.t) / square_t + dt, ss, st, tt,
          r2 * dot(axis, axis) + s * ds + t * dt};
}

/// The pixel filter along an axis.
class FilterAxis {
 public:
  explicit FilterAxis(const PixelFilter& filter) : places_(filter.places) {}

  /// The largest distance from the pixel's centre, px.
  double reach() const { return places_ != nullptr ? places_[PixelFilter::kSteps] : 0.5; }
  /// The place at a share of the filter's weight, px from the pixel's centre.
  double place(double share) const {
    const double from_center = share - 0.5;
    if (places_ == nullptr) return from_center;
    const double at = std::abs(2 * from_center) * PixelFilter::kSteps;
    const auto step = std::min(static_cast<int>(at), PixelFilter::kSteps - 1);
    return std::copysign(places_[step] + (places_[step + 1] - places_[step]) * (at - step), from_center);
  }
  /// The share of the weight before a place.
  double share(double place) const {
    if (places_ == nullptr) return std::clamp(place + 0.5, 0.0, 1.0);
    const double* const above = above_of(place);
    const double step = above == end() ? PixelFilter::kSteps
                                       : static_cast<double>(above - 1 - places_) +
                                             (std::abs(place) - above[-1]) / (above[0] - above[-1]);
    return 0.5 + std::copysign(step / (2 * PixelFilter::kSteps), place);
  }
  /// Per pixel.
  double density(double place) const {
    if (places_ == nullptr) return std::abs(place) <= 0.5 ? 1 : 0;
    const double* const above = above_of(place);
    return above == end() ? 0 : 0.5 / (PixelFilter::kSteps * (above[0] - above[-1]));
  }

 private:
  const double* end() const { return places_ + PixelFilter::kSteps + 1; }
  const double* above_of(double place) const { return std::upper_bound(places_ + 1, end(), std::abs(place)); }
  const double* places_;
};

/// A point of the plane, and the area that it stands for.
struct Place {
  double s = 0, t = 0, area = 0;
};

/// A point of an ellipse within bounds: uniform in all of it if it is within, otherwise in bounds of the part within.
Place sample_within(const Ellipse& ellipse, Interval within_s, Interval within_t, bool is_within,
                    const SeenEmitterNumbers& numbers) {
  if (is_within) {
    const double dt = std::sqrt(ellipse.square * ellipse.ss / ellipse.determinant) * numbers.disc[1];
    const double ds = std::sqrt(ellipse.square / ellipse.ss) * numbers.disc[0] - ellipse.st / ellipse.ss * dt;
    return {ellipse.s + ds, ellipse.t + dt, ellipse.area()};
  }
  const Interval s = ellipse.bounds_s(within_s, within_t), t = ellipse.swapped().bounds_s(within_t, within_s);
  if (!(s.low < s.high && t.low < t.high)) return {};
  const Place out{s.at(numbers.other[0]), t.at(numbers.other[1]), s.width() * t.width()};
  return ellipse.contains(out.s, out.t) ? out : Place{};
}

}  // namespace

FilmDisc film_disc(const Camera& camera, const Sphere& sphere) noexcept {
  const Vec3d to = Vec3d{sphere.x, sphere.y, sphere.z} - camera.origin;
  const double focus = length(camera.forward), z = dot(to, camera.forward) / focus;
  const double scale = focus / z, near = focus / (z - sphere.radius), far = focus / (z + sphere.radius);
  // A sphere beside the axis has an elliptical image; its half-axes are at most this.
  const double aside = std::sqrt(dot(to, to) - z * z), beyond = z * z - sphere.radius * sphere.radius;
  const double sharp = focus * sphere.radius * (std::sqrt(aside * aside + beyond) + aside * sphere.radius / z) / beyond;
  const double blur = length(camera.lens_u) * std::fmax(std::abs(1 - near), std::abs(1 - far));
  const double width2 = dot(camera.right, camera.right), height2 = dot(camera.down, camera.down);
  return {dot(to, camera.right) / width2 * scale, dot(to, camera.down) / height2 * scale,
          (sharp + blur) / std::sqrt(std::fmin(width2, height2)) * (1 + 1e-9)};
}

SeenEmitterChoice choose_seen_emitter(std::span<const SeenEmitter> emitters, double choice) noexcept {
  const auto share_end = [](const SeenEmitter& e) { return double{e.share_end}; };
  const auto chosen = std::min(std::ranges::upper_bound(emitters, choice, {}, share_end), emitters.end() - 1);
  return {*chosen, share_end(*chosen) - (chosen == emitters.begin() ? 0 : share_end(chosen[-1]))};
}

SeenEmitterSample sample_seen_emitter(const SceneView& scene, const SeenEmitter& emitter, const double (&pixel)[2],
                                      const SeenEmitterNumbers& numbers) noexcept {
  const Sphere sphere = scene.spheres[emitter.id];
  const Camera& camera = scene.camera;
  const FilterAxis filter(scene.filter);
  const Vec3d center = Vec3d{sphere.x, sphere.y, sphere.z} - camera.origin;
  const auto on_film = [&](double x, double y) { return camera.forward + camera.right * x + camera.down * y; };
  const auto on_lens = [&](double u, double v) { return camera.lens_u * u + camera.lens_v * v; };
  Vec3d lens, film;
  double weight;
  if (emitter.by_lens) {
    // A point of the part of the pixel that the blurred image may touch: of the filter within bounds of this part.
    const FilmDisc disc = film_disc(camera, sphere);
    const Ellipse image{disc.x - pixel[0], disc.y - pixel[1], 1, 0, 1, disc.radius * disc.radius};
    const Interval support{-filter.reach(), filter.reach()};
    const Interval x = image.bounds_s(support, support), y = image.swapped().bounds_s(support, support);
    if (!(x.low < x.high && y.low < y.high)) return {};
    const Interval x_shares{filter.share(x.low), filter.share(x.high)},
        y_shares{filter.share(y.low), filter.share(y.high)};
    film = on_film(pixel[0] + filter.place(x_shares.at(numbers.film[0])),
                   pixel[1] + filter.place(y_shares.at(numbers.film[1])));
    const Ellipse ellipse = section({{}, camera.lens_u, camera.lens_v}, film, center - film, sphere.radius);
    const bool is_within =
        std::hypot(ellipse.s, ellipse.t) + std::hypot(ellipse.half_s(), ellipse.swapped().half_s()) <= 1;
    const Place at = sample_within(ellipse, {-1, 1}, {-1, 1}, is_within, numbers);
    lens = on_lens(at.s, at.t);
    weight = at.s * at.s + at.t * at.t <= 1 ? at.area / std::numbers::pi * x_shares.width() * y_shares.width() : 0;
  } else {
    lens = on_lens(numbers.lens[0], numbers.lens[1]);
    const Ellipse ellipse = section({camera.forward, camera.right, camera.down}, lens, center - lens, sphere.radius);
    const Interval x{pixel[0] - filter.reach(), pixel[0] + filter.reach()},
        y{pixel[1] - filter.reach(), pixel[1] + filter.reach()};
    const double half_x = ellipse.half_s(), half_y = ellipse.swapped().half_s();
    const bool is_within = ellipse.s - half_x >= x.low && ellipse.s + half_x <= x.high && ellipse.t - half_y >= y.low &&
                           ellipse.t + half_y <= y.high;
    const Place at = sample_within(ellipse, x, y, is_within, numbers);
    film = on_film(at.s, at.t);
    weight = at.area * filter.density(at.s - pixel[0]) * filter.density(at.t - pixel[1]);
  }
  if (!(weight > 0)) return {};
  const Vec3d direction = normalized(film - lens), to = center - lens;
  const double along = dot(to, direction);
  const Vec3d aside = to - direction * along;
  const double inside = std::sqrt(std::fmax(sphere.radius * sphere.radius - dot(aside, aside), 0));
  return {lens, direction * (along - inside), weight};
}

double camera_ray_density(const SceneView& scene, const double (&pixel)[2], Vec3d offset, Vec3d direction) noexcept {
  const Camera& camera = scene.camera;
  const Vec3d normal = cross(camera.right, camera.down);  // as long as a pixel is large
  const double along = dot(direction, normal), reach = dot(camera.forward - offset, normal) / along;
  if (!(reach > 0)) return 0;
  const FilterAxis filter(scene.filter);
  const Vec3d film = offset + direction * reach - camera.forward;
  const double x = dot(film, camera.right) / dot(camera.right, camera.right),
               y = dot(film, camera.down) / dot(camera.down, camera.down);
  return filter.density(x - pixel[0]) * filter.density(y - pixel[1]) * reach * reach / std::abs(along);
}

}  // namespace orrery::kernel
