// SPDX-License-Identifier: Apache-2.0
#include "accel/box_frame.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "math/scalar.h"

namespace orrery::accel {
namespace {

using math::rounded_down;
using math::rounded_up;

/// Padding of boxes as a fraction of the largest coordinate. The derived worst case is 14 x 2^-24, from the rounding of
/// origin, direction, reciprocal and box in Embree's slab test; 2^-20 is the next power of two.
constexpr double kPadding = 0x1p-20;

/// Bound on a ray origin's distance from the centre on each axis, in units of `reach` (to_box_space): sqrt(2), rounded
/// up.
constexpr double kFarthestStart = 1.5;

}  // namespace

BoxFrame::BoxFrame(const BoundedSpheres& spheres, const std::vector<std::uint32_t>& ids, const BoundedRods& rods) {
  // Includes the spheres, the ends of rods, and where they move, in a value.
  const auto accumulated = [&](const auto& start, auto add, auto join) {
    auto out = base::accumulate_parallel(
        ids.size(), start,
        [&](auto& value, std::size_t i) {
          add(value, spheres[ids[i]]);
          if (ids[i] < spheres.moving_count) add(value, spheres.at(ids[i], 1));
        },
        join);
    const auto of_rods = base::accumulate_parallel(
        rods.rods.count, start,
        [&](auto& value, std::size_t i) {
          for (int step = 0; step < (rods.rods.moves(i) ? 2 : 1); ++step) {
            const kernel::Rod rod = rods.at(i, step);
            add(value, kernel::Sphere{rod.a[0], rod.a[1], rod.a[2], rod.radius});
            add(value, kernel::Sphere{rod.b[0], rod.b[1], rod.b[2], rod.radius});
          }
        },
        join);
    join(out, of_rods);
    return out;
  };
  const bool moves = spheres.moving_count > 0 || rods.rods.any_moves();
  using math::kInfinity;
  struct Corners {
    double lower[3], upper[3];
  };
  const auto [lower, upper] = accumulated(
      Corners{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}},
      [](Corners& all, const kernel::Sphere& s) {
        const double center[3] = {s.x, s.y, s.z};
        for (int axis = 0; axis < 3; ++axis) {
          all.lower[axis] = std::min(all.lower[axis], center[axis] - s.radius);
          all.upper[axis] = std::max(all.upper[axis], center[axis] + s.radius);
        }
      },
      [](Corners& a, const Corners& b) {
        for (int axis = 0; axis < 3; ++axis) {
          a.lower[axis] = std::min(a.lower[axis], b.lower[axis]);
          a.upper[axis] = std::max(a.upper[axis], b.upper[axis]);
        }
      });
  for (int axis = 0; axis < 3; ++axis) {
    middle[axis] = lower[axis] / 2 + upper[axis] / 2;
    if (spheres.in_single)
      middle[axis] = math::in_single_precision(middle[axis]);  // rays are translated by the same value
  }
  // Measured from the rounded centre, which far from the world origin differs from that of the corners.
  const double half = accumulated(
      0.0,
      [&](double& most, const kernel::Sphere& s) {
        most = std::max({most, std::abs(s.x - middle[0]) + s.radius, std::abs(s.y - middle[1]) + s.radius,
                         std::abs(s.z - middle[2]) + s.radius});
      },
      [](double& a, double b) { a = std::max(a, b); });
  scale = std::ldexp(1.0, -std::ilogb(half));
  reach = half * scale * 1.8;  // sqrt(3) for the box's corners, plus room for the padding
  // Embree also interpolates motion-blurred bounds in single precision, which costs some more bits.
  padding = kPadding * reach * kFarthestStart * (moves ? 2 : 1);
  if (!spheres.in_single || !moves) return;
  // The kernel rounds the interpolated sphere or rod, whose coordinates are each the sum of two rounded numbers.
  double largest = 0;
  for (int axis = 0; axis < 3; ++axis) largest = std::max({largest, std::abs(lower[axis]), std::abs(upper[axis])});
  padding += 0x1p-22 * largest * scale;
}

BoxFrame::Box BoxFrame::box(const kernel::Rod& rod, double from, double to) const noexcept {
  const auto at = [&](double place) {
    const auto coordinate = [&](int k) { return rod.a[k] + (rod.b[k] - rod.a[k]) * place; };
    return box(kernel::Sphere{coordinate(0), coordinate(1), coordinate(2), rod.radius});
  };
  Box out = at(from);
  const Box other = at(to);
  for (int k = 0; k < 3; ++k) {
    out.lower[k] = std::min(out.lower[k], other.lower[k]);
    out.upper[k] = std::max(out.upper[k], other.upper[k]);
  }
  return out;
}

BoxFrame::Box BoxFrame::box(const kernel::Sphere& sphere) const noexcept {
  const double center[3] = {sphere.x, sphere.y, sphere.z};
  Box out;
  for (int axis = 0; axis < 3; ++axis) {
    const double at = (center[axis] - middle[axis]) * scale, radius = sphere.radius * scale;
    out.lower[axis] = rounded_down(at - radius - padding);
    out.upper[axis] = rounded_up(at + radius + padding);
  }
  return out;
}

}  // namespace orrery::accel
