// SPDX-License-Identifier: Apache-2.0
#include "plot/view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <tuple>

#include <fmt/core.h>

#include "base/error.h"
#include "base/text.h"
#include "math/scalar.h"
#include "scene/limits.h"
#include "scene/scene.h"

namespace orrery::plot {
namespace {

/// Part of the image's width and height that stays free on each side.
constexpr double kMargin = 0.05;

std::optional<std::pair<double, double>> parse_angles(const std::string& text) {
  const std::string_view view = text;
  const std::size_t comma = std::min(view.find(','), view.size());
  std::pair<double, double> out;
  const bool is_pair = comma < view.size() && base::from_text(view.substr(0, comma), out.first) &&
                       base::from_text(view.substr(comma + 1), out.second);
  if (!is_pair || !std::isfinite(out.first) || !(std::abs(out.second) <= 90)) return {};
  return out;
}

/// The scene's axes: up, front (towards a viewer at azimuth 0) and right. Right-handed in the order right, up, front.
struct SceneAxes {
  Vec3d right, up, front;
};

SceneAxes scene_axes(const std::string& up) {
  if (up == "x") return {{0, 1, 0}, {1, 0, 0}, {0, 0, -1}};
  if (up == "y") return {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  if (up == "z") return {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}};
  base::refuse(fmt::format("--up: `{}` is not an axis; write x, y or z", up));
}

/// Rounds away the residue of sines and cosines of right angles.
Vec3d clean(Vec3d v) {
  constexpr double kResidue = 1e-15;
  const auto rounded = [](double x) { return std::abs(x) < kResidue ? 0.0 : x; };
  return {rounded(v.x), rounded(v.y), rounded(v.z)};
}

/// A direction, and the standard deviation of points along it.
struct PrincipalAxis {
  double deviation = 0;
  Vec3d direction;
};

/// The principal axes of points, the one with the largest deviation first.
std::array<PrincipalAxis, 3> principal_axes_of(const scene::PointArray& points, std::size_t count) {
  const double share = 1 / static_cast<double>(count);
  Vec3d mean{0, 0, 0};
  for (std::size_t i = 0; i < count; ++i) mean = mean + points[i] * share;
  std::array<std::array<double, 3>, 3> a{};  // the covariance matrix
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3d d = points[i] - mean;
    const double from_mean[3] = {d.x, d.y, d.z};
    for (std::size_t row = 0; row < 3; ++row)
      for (std::size_t column = 0; column < 3; ++column) a[row][column] += from_mean[row] * from_mean[column] * share;
  }
  // Jacobi's method: rotations about the axes, each of which makes an element 0.
  std::array<Vec3d, 3> axes = {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}};
  constexpr int kSweeps = 12;  // converges quadratically
  for (int step = 0; step < 3 * kSweeps; ++step) {
    const auto p = static_cast<std::size_t>(step % 3), q = (p + 1) % 3;
    if (a[p][q] == 0) continue;
    const double theta = std::atan2(2 * a[p][q], a[p][p] - a[q][q]) / 2, c = std::cos(theta), s = std::sin(theta);
    for (std::size_t k = 0; k < 3; ++k)
      std::tie(a[k][p], a[k][q]) = std::pair(c * a[k][p] + s * a[k][q], c * a[k][q] - s * a[k][p]);
    for (std::size_t k = 0; k < 3; ++k)
      std::tie(a[p][k], a[q][k]) = std::pair(c * a[p][k] + s * a[q][k], c * a[q][k] - s * a[p][k]);
    std::tie(axes[p], axes[q]) = std::pair(axes[p] * c + axes[q] * s, axes[q] * c - axes[p] * s);
  }
  std::array<PrincipalAxis, 3> out;
  for (std::size_t k = 0; k < 3; ++k) out[k] = {std::sqrt(std::max(a[k][k], 0.0)), axes[k]};
  std::sort(out.begin(), out.end(), [](const auto& x, const auto& y) { return x.deviation > y.deviation; });
  return out;
}

/// The part of a vector that is perpendicular to a unit vector, of length 1; that of `other` if they are parallel.
Vec3d perpendicular(Vec3d v, Vec3d axis, Vec3d other) {
  constexpr double kParallel = 0.99;
  const double along = math::dot(v, axis);
  return std::abs(along) > kParallel ? math::normalized(other - axis * math::dot(other, axis))
                                     : math::normalized(v - axis * along);
}

}  // namespace

Vec3d axis_of(const std::string& name) {
  return {name == "x" ? 1.0 : 0.0, name == "y" ? 1.0 : 0.0, name == "z" ? 1.0 : 0.0};
}

ViewAxes view_axes(const std::string& look_from, const std::string& up) {
  const SceneAxes scene = scene_axes(up);
  const bool is_axis = look_from.size() == 2 && (look_from[0] == '+' || look_from[0] == '-') && look_from[1] >= 'x' &&
                       look_from[1] <= 'z';
  if (is_axis) {
    const Vec3d back = axis_of(look_from.substr(1)) * (look_from[0] == '+' ? 1.0 : -1.0);
    // Seen from above, the scene's front is at the bottom of the image; from below, at the top.
    const bool is_vertical = std::abs(math::dot(back, scene.up)) > 0.5;
    const Vec3d above = is_vertical ? scene.front * -math::dot(back, scene.up) : scene.up;
    return {math::cross(above, back), above, back};
  }
  std::optional<std::pair<double, double>> angles;
  if (look_from == "iso")
    angles = {45, std::atan(std::sqrt(0.5)) * 180 / std::numbers::pi};
  else
    angles = parse_angles(look_from);
  if (!angles)
    base::refuse(
        fmt::format("--look-from: `{}` is not a view; write auto, iso, +x, -x, +y, "
                    "-y, +z, -z, or AZIMUTH,ELEVATION in degrees, e.g. 30,20",
                    look_from));
  const double azimuth = angles->first / 180 * std::numbers::pi, elevation = angles->second / 180 * std::numbers::pi;
  const Vec3d level = scene.front * std::cos(azimuth) + scene.right * std::sin(azimuth);
  ViewAxes out;
  out.back = clean(level * std::cos(elevation) + scene.up * std::sin(elevation));
  out.right = clean(scene.right * std::cos(azimuth) - scene.front * std::sin(azimuth));
  out.up = clean(math::cross(out.back, out.right));
  return out;
}

bool are_flat(const scene::PointArray& points, std::size_t count, Vec3d up) {
  constexpr double kFlat = 0.25, kParallel = 0.9;
  if (count == 0) return false;
  const auto [longest, middle, shortest] = principal_axes_of(points, count);
  return shortest.deviation < kFlat * middle.deviation && std::abs(math::dot(shortest.direction, up)) > kParallel;
}

ViewAxes principal_axes(const scene::PointArray& points, std::size_t count, const ViewAxes& near, bool is_tall) {
  constexpr double kAlike = 1.1, kRounding = 1e-6;
  if (count == 0) return near;
  const auto [longest, middle, shortest] = principal_axes_of(points, count);
  const double rounding = kRounding * longest.deviation;
  const bool is_disc = longest.deviation <= kAlike * middle.deviation;
  const bool is_rod = middle.deviation <= kAlike * shortest.deviation || middle.deviation <= rounding;
  if (is_disc && is_rod) return near;
  const auto toward = [](Vec3d axis, Vec3d direction) { return math::dot(axis, direction) < 0 ? axis * -1.0 : axis; };
  if (is_disc) {
    const Vec3d back = toward(shortest.direction, near.back), up = perpendicular(near.up, back, near.right * -1.0);
    return {math::cross(up, back), up, back};
  }
  if (is_rod) {
    const Vec3d along = toward(longest.direction, is_tall ? near.up : near.right);
    const Vec3d back = perpendicular(near.back, along, is_tall ? near.right : near.up);
    return is_tall ? ViewAxes{math::cross(along, back), along, back} : ViewAxes{along, math::cross(back, along), back};
  }
  ViewAxes out = near;
  double closest = -math::kInfinity;
  for (const double sign : {1.0, -1.0})
    for (const double other_sign : {1.0, -1.0}) {
      const Vec3d right = (is_tall ? middle : longest).direction * sign;
      const Vec3d up = (is_tall ? longest : middle).direction * other_sign, back = math::cross(right, up);
      const double closeness = math::dot(right, near.right) + math::dot(up, near.up) + math::dot(back, near.back);
      if (closeness <= closest) continue;
      closest = closeness;
      out = {right, up, back};
    }
  return out;
}

void slice(std::pair<int, double> plane, const ViewAxes& axes, scene::PointsKeys& points) {
  const auto [axis, place] = plane;
  const double back[3] = {axes.back.x, axes.back.y, axes.back.z};
  std::optional<scene::Interval>& clip = points.clip[static_cast<std::size_t>(axis)];
  if (!clip) clip = scene::Interval{-scene::kLargestLength, scene::kLargestLength};
  if (back[axis] > 0)
    clip->high = std::min(clip->high, place);
  else
    clip->low = std::max(clip->low, place);
}

void ViewExtent::add(const scene::Points& points) {
  for (std::size_t i = 0; i < points.centers.size(); ++i) add(points.centers[i], points.radii[i]);
  for (const scene::BondStub& stub : points.bond_stubs) add(stub.end, points.bond_radius_of(stub.sphere));
}

void ViewExtent::add(Vec3d center, double radius) {
  const Vec3d axes[3] = {axes_.right, axes_.up, axes_.back};
  for (int k = 0; k < 3; ++k) add(k, math::dot(center, axes[k]), std::abs(radius));
  is_empty_ = false;
}

void ViewExtent::add_orbits(const scene::Points& points, Vec3d pivot, Vec3d axis) {
  const Vec3d axes[3] = {axes_.right, axes_.up, axes_.back};
  const auto add_orbit = [&](Vec3d center, double radius) {
    const Vec3d from_pivot = center - pivot;
    const double height = math::dot(from_pivot, axis), distance = math::length(from_pivot - axis * height);
    for (int k = 0; k < 3; ++k) {
      const double along = math::dot(axis, axes[k]), across = std::sqrt(std::max(0.0, 1 - along * along));
      add(k, math::dot(pivot, axes[k]), std::abs(height * along) + distance * across + std::abs(radius));
    }
    is_empty_ = false;
  };
  for (std::size_t i = 0; i < points.centers.size(); ++i) add_orbit(points.centers[i], points.radii[i]);
  for (const scene::BondStub& stub : points.bond_stubs) add_orbit(stub.end, points.bond_radius_of(stub.sphere));
}

void ViewExtent::add(int k, double at, double reach) {
  low_[k] = is_empty_ ? at - reach : std::min(low_[k], at - reach);
  high_[k] = is_empty_ ? at + reach : std::max(high_[k], at + reach);
}

Vec3d ViewExtent::center() const {
  return axes_.right * ((low_[0] + high_[0]) / 2) + axes_.up * ((low_[1] + high_[1]) / 2) +
         axes_.back * ((low_[2] + high_[2]) / 2);
}

double ViewExtent::radius() const {
  const double radius = is_empty_ ? 0 : std::hypot(high_[0] - low_[0], high_[1] - low_[1], high_[2] - low_[2]) / 2;
  return radius > 0 ? radius : 1;  // a single point has no extent
}

Vec3d ViewExtent::beside(double gap) const {
  return axes_.right * (low_[0] - gap) + axes_.up * low_[1] + axes_.back * ((low_[2] + high_[2]) / 2);
}

scene::Interval ViewExtent::depths(const scene::Camera& camera) const {
  const Vec3d axes[3] = {axes_.right, axes_.up, axes_.back};
  const Vec3d forward = math::normalized(camera.look_at - camera.look_from);
  double half = 0;
  for (int k = 0; k < 3; ++k) half += std::abs(math::dot(axes[k], forward)) * (high_[k] - low_[k]) / 2;
  const double middle = math::dot(center() - camera.look_from, forward);
  return {middle - half, middle + half};
}

Ground ground_below(double lowest, Vec3d up, const ViewExtent& extent) {
  constexpr double kLarge = 1000;
  const double radius = kLarge * extent.radius();
  const Vec3d center = extent.center();
  return {center + up * (lowest - radius - math::dot(center, up)), radius};
}

bool hides_view(const Ground& ground, const scene::Camera& camera, double aspect) {
  const Vec3d back = math::normalized(camera.look_from - camera.look_at);
  const Vec3d right = math::normalized(math::cross(camera.up, back)), up = math::cross(back, right);
  const double half_width = camera.width.value_or(0) / 2;  // the rays of a perspective camera begin at one point
  for (const double x : {-half_width, half_width})
    for (const double y : {-half_width / aspect, half_width / aspect})
      if (math::length(camera.look_from + right * x + up * y - ground.center) < ground.radius) return true;
  return false;
}

void look_at(Vec3d target, const ViewAxes& axes, scene::Camera& camera) {
  const Vec3d shift = target - camera.look_at;
  camera.look_at = target;
  // A perspective camera keeps its distance to what is in front of the target.
  camera.look_from =
      camera.look_from +
      (camera.projection == scene::Projection::kOrthographic ? shift : shift - axes.back * math::dot(shift, axes.back));
}

void magnify(scene::Camera& camera, double zoom) {
  if (camera.width) {
    camera.width = *camera.width / zoom;
    return;
  }
  constexpr double kHalfDegree = std::numbers::pi / 360;
  if (zoom != 1) camera.vfov = std::atan(std::tan(camera.vfov * kHalfDegree) / zoom) / kHalfDegree;
}

ViewExtent ViewExtent::grown(double length) const {
  ViewExtent out = *this;
  for (int k = 0; k < 3 && !is_empty_; ++k) {
    out.low_[k] -= length;
    out.high_[k] += length;
  }
  return out;
}

double ViewExtent::image_width(double aspect, const std::vector<Reserved>& reserved) const {
  constexpr double kSmallest = 0.1;  // of `beside` and `above`
  const double wide = high_[0] - low_[0], high = (high_[1] - low_[1]) * aspect;
  const double fitted = std::max(wide, high);
  if (is_empty_ || !(fitted > 0)) return 2;  // a single point has no extent
  double out = fitted / (1 - 2 * kMargin);
  for (const Reserved& rectangle : reserved) {
    const double by_width = rectangle.beside < kSmallest ? math::kInfinity : wide / (2 * rectangle.beside),
                 by_height = rectangle.above < kSmallest ? math::kInfinity : high / (2 * rectangle.above);
    const double needed = std::min(by_width, by_height);
    if (needed < math::kInfinity) out = std::max(out, needed);
  }
  return out;
}

scene::Camera ViewExtent::camera(double aspect, std::optional<double> vfov_deg,
                                 const std::vector<Reserved>& reserved) const {
  scene::Camera camera;
  camera.up = axes_.up;
  camera.look_at = center();
  const double width = image_width(aspect, reserved);
  double distance = 2 * radius();  // parallel rays may start anywhere in front of all spheres
  if (vfov_deg) {
    camera.vfov = *vfov_deg;
    // The box that contains the spheres is seen if its face in front is.
    distance = (high_[2] - low_[2]) / 2 + width / aspect / 2 / std::tan(*vfov_deg / 360 * std::numbers::pi);
  } else {
    camera.projection = scene::Projection::kOrthographic;
    camera.width = width;
  }
  camera.look_from = camera.look_at + axes_.back * distance;
  return camera;
}

}  // namespace orrery::plot
