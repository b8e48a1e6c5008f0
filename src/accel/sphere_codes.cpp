// SPDX-License-Identifier: Apache-2.0
#include "accel/sphere_codes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "math/scalar.h"

namespace orrery::accel {

namespace {

using math::rounded_up;

/// As code_above(), of a lower bound: the decoded bound is not above `bound`.
std::uint8_t code_below(float bound, float origin, float step) {
  int code = std::clamp(static_cast<int>((bound - origin) / step), 0, 255);
  while (code > 0 && std::fma(static_cast<float>(code), step, origin) > bound) --code;
  return static_cast<std::uint8_t>(code);
}

}  // namespace

std::uint8_t code_above(float bound, float origin, float step) {
  int code = std::clamp(static_cast<int>((bound - origin) / step), 0, 255);
  while (code < 255 && std::fma(static_cast<float>(code), step, origin) < bound) ++code;
  return static_cast<std::uint8_t>(code);
}

float step_between(float lower, float upper) {
  float step = std::max((upper - lower) / 255, std::numeric_limits<float>::min());
  while (std::fma(255.0F, step, lower) < upper) step = std::nextafter(step * (1 + 0x1p-23F), kInfinity);
  return step;
}

SphereBvh::Node make_node(std::span<const Bounds> children, std::uint32_t first) {
  Bounds all;
  for (const Bounds& child : children) all.add(child);
  SphereBvh::Node node{};
  node.first = first;
  node.count = static_cast<std::uint32_t>(children.size());
  for (int axis = 0; axis < 3; ++axis) {
    const float origin = all.lower[axis], step = step_between(origin, all.upper[axis]);
    node.origin[axis] = origin;
    node.step[axis] = step;
    std::fill_n(node.bound[0][axis], kArity, std::uint8_t{255});
    for (std::size_t i = 0; i < children.size(); ++i) {
      node.bound[0][axis][i] = code_below(children[i].lower[axis], origin, step);
      node.bound[1][axis][i] = code_above(children[i].upper[axis], origin, step);
    }
  }
  return node;
}

SphereBvh::Leaf make_leaf(std::span<const SphereItem> items) {
  Bounds all;
  for (const SphereItem& item : items) all.add(item.center, item.center);
  SphereBvh::Leaf leaf{};
  leaf.step = 0;
  for (int axis = 0; axis < 3; ++axis) {
    leaf.origin[axis] = all.lower[axis];
    leaf.step = std::max(leaf.step, step_between(all.lower[axis], all.upper[axis]));
  }
  std::fill_n(leaf.ids, kArity, kernel::kNone);
  for (std::size_t i = 0; i < items.size(); ++i) {
    leaf.ids[i] = items[i].id;
    for (int axis = 0; axis < 3; ++axis) {
      const float steps = (items[i].center[axis] - leaf.origin[axis]) / leaf.step;
      // As std::lround, which is a call: the sum is exact.
      leaf.center[axis][i] =
          static_cast<std::uint8_t>(std::min(static_cast<int>(static_cast<double>(steps) + 0.5), 255));
    }
  }
  return leaf;
}

SphereBvh::LeafRods make_leaf_rods(const SphereBvh::Leaf& leaf, std::size_t count, const BoundedSpheres& spheres,
                                   const BoundedRods& rods, const BoxFrame& frame) {
  SphereBvh::LeafRods out{};
  const auto each = [&](auto f) {
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t id = leaf.ids[i];
      if (rods.rods.contains(id))
        f(i, RodExtent(rods.at(rods.rods.index(id), 0), frame), true);
      else if (id < spheres.moving_count)
        f(i, RodExtent(path_of(spheres, id), frame), false);
    }
  };
  double most = 0, thickest = 0, thinnest = std::numeric_limits<double>::infinity();
  each([&](std::size_t i, const RodExtent& rod, bool is_rod) {
    for (const double x : rod.half) most = std::max(most, std::abs(x));
    if (!is_rod) return;
    out.rods |= 1u << i;
    thickest = std::max(thickest, rod.radius);
    thinnest = std::min(thinnest, rod.radius);
  });
  if (out.rods == 0 && most == 0) return out;
  out.step = std::max(rounded_up(most / kLargestHalfCode), std::numeric_limits<float>::min());
  out.radius = rounded_up(thickest);
  out.least_radius = math::rounded_down(thinnest);
  each([&](std::size_t i, const RodExtent& rod, bool) {
    for (int axis = 0; axis < 3; ++axis)
      out.half[axis][i] = static_cast<std::int8_t>(std::lround(rod.half[axis] / out.step));
  });
  return out;
}

}  // namespace orrery::accel
