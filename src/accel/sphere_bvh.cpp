// SPDX-License-Identifier: Apache-2.0
#include "accel/sphere_bvh.h"

#include <sys/mman.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <utility>

#include "base/stop_point.h"
#include "math/scalar.h"

namespace orrery::accel {
namespace {

using math::rounded_up;

/// Padding in units of the frame's reach. Derived in docs/decisions/0027-bvh-for-many-spheres.md: rounding moves a
/// ray by at most 40 x 2^-24 relative to a sphere and by at most 19 x 2^-24 relative to a box.
constexpr double kSpherePadding = 0x1.4p-17, kBoxPadding = 0x1p-18;

/// Number of leaves that are created before the memory of their items is released, and of items before that of their
/// ids.
constexpr std::size_t kReleasedLeaves = 1 << 16, kReleasedIds = kReleasedLeaves * kArity;

struct Bounds {
  float lower[3] = {kInfinity, kInfinity, kInfinity};
  float upper[3] = {-kInfinity, -kInfinity, -kInfinity};

  void add(const float (&low)[3], const float (&high)[3]) {
    for (int k = 0; k < 3; ++k) {
      lower[k] = std::min(lower[k], low[k]);
      upper[k] = std::max(upper[k], high[k]);
    }
  }
  void add(const Bounds& b) { add(b.lower, b.upper); }
};

/// Returns memory to the operating system. The elements are zero from then on.
template <class T>
void release(T* begin, T* end) {
  const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
  const auto first = (reinterpret_cast<std::uintptr_t>(begin) + page - 1) / page * page,
             last = reinterpret_cast<std::uintptr_t>(end) / page * page;
  if (first < last) madvise(reinterpret_cast<void*>(first), last - first, MADV_DONTNEED);
}

/// Quantizes a bound, rounding down and up respectively: the decoded bound is at most, or at least, `bound`.
///
/// Domain     `bound` is between the origin and the decoded value of 255
std::uint8_t code_below(float bound, float origin, float step) {
  int code = std::clamp(static_cast<int>((bound - origin) / step), 0, 255);
  while (code > 0 && std::fma(static_cast<float>(code), step, origin) > bound) --code;
  return static_cast<std::uint8_t>(code);
}
std::uint8_t code_above(float bound, float origin, float step) {
  int code = std::clamp(static_cast<int>((bound - origin) / step), 0, 255);
  while (code < 255 && std::fma(static_cast<float>(code), step, origin) < bound) ++code;
  return static_cast<std::uint8_t>(code);
}

/// The smallest step with which 255 steps from `lower` reach `upper`.
float step_between(float lower, float upper) {
  float step = std::max((upper - lower) / 255, std::numeric_limits<float>::min());
  while (std::fma(255.0F, step, lower) < upper) step = std::nextafter(step * (1 + 0x1p-23F), kInfinity);
  return step;
}

SphereBvh::Node make_node(const Bounds* children, std::size_t count, std::uint32_t first) {
  Bounds all;
  for (std::size_t i = 0; i < count; ++i) all.add(children[i]);
  SphereBvh::Node node{};
  node.first = first;
  node.count = static_cast<std::uint32_t>(count);
  for (int axis = 0; axis < 3; ++axis) {
    const float origin = all.lower[axis], step = step_between(origin, all.upper[axis]);
    node.origin[axis] = origin;
    node.step[axis] = step;
    std::fill_n(node.bound[0][axis], kArity, std::uint8_t{255});
    for (std::size_t i = 0; i < count; ++i) {
      node.bound[0][axis][i] = code_below(children[i].lower[axis], origin, step);
      node.bound[1][axis][i] = code_above(children[i].upper[axis], origin, step);
    }
  }
  return node;
}

SphereBvh::Leaf make_leaf(const SphereItem* items, std::size_t count) {
  Bounds all;
  for (std::size_t i = 0; i < count; ++i) all.add(items[i].center, items[i].center);
  SphereBvh::Leaf leaf{};
  leaf.step = 0;
  for (int axis = 0; axis < 3; ++axis) {
    leaf.origin[axis] = all.lower[axis];
    leaf.step = std::max(leaf.step, step_between(all.lower[axis], all.upper[axis]));
  }
  std::fill_n(leaf.ids, kArity, kernel::kNoSphere);
  for (std::size_t i = 0; i < count; ++i) {
    leaf.ids[i] = items[i].id;
    for (int axis = 0; axis < 3; ++axis)
      leaf.center[axis][i] = static_cast<std::uint8_t>(
          std::clamp(std::lround((items[i].center[axis] - leaf.origin[axis]) / leaf.step), 0L, 255L));
  }
  return leaf;
}

}  // namespace

SphereBvh::SphereBvh(const BoundedSpheres& spheres, std::vector<std::uint32_t> ids, const BoxFrame& frame,
                     const std::function<bool(double)>& monitor)
    : count(ids.size()) {
  using Range = tbb::blocked_range<std::size_t>;
  const std::size_t leaf_count = (count + kArity - 1) / kArity;
  padding = rounded_up(kSpherePadding * frame.reach);
  double smallest = std::numeric_limits<double>::infinity(), largest = 0, sum = 0;
  const base::StopPoint stop;
  for (const std::uint32_t id : ids) {
    const double r = spheres[id].radius;
    smallest = std::min(smallest, r);
    largest = std::max(largest, r);
    sum += r;
  }
  const bool own_radii = smallest < largest;
  radius = rounded_up(largest * frame.scale);
  const std::size_t id_count = std::size_t{*std::max_element(ids.begin(), ids.end())} + 1;

  stop.check();
  using Allocator = base::HugePageAllocator<SphereItem>;
  const auto free_items = [n = count](SphereItem* p) { Allocator().deallocate(p, n); };
  // Its pages are first touched in parallel.
  std::unique_ptr<SphereItem[], decltype(free_items)> storage(Allocator().allocate(count), free_items);
  const std::span<SphereItem> items(storage.get(), count);
  const auto make_items = [&](const Range& range) {
    stop.check();
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      const kernel::Sphere s = spheres[ids[i]];
      items[i] = {{static_cast<float>((s.x - frame.middle[0]) * frame.scale),
                   static_cast<float>((s.y - frame.middle[1]) * frame.scale),
                   static_cast<float>((s.z - frame.middle[2]) * frame.scale)},
                  ids[i]};
    }
  };
  for (std::size_t begin = 0; begin < count; begin += kReleasedIds) {
    const std::size_t end = std::min(count, begin + kReleasedIds);
    tbb::parallel_for(Range(begin, end, 4096), make_items);
    release(&ids[begin], &ids[0] + end);
  }
  std::vector<std::uint32_t>().swap(ids);  // copied to the items
  const float box_padding = rounded_up(kBoxPadding * frame.reach);
  const NodeCells node_cells = sort_spheres(items, static_cast<float>(sum / static_cast<double>(count) * frame.scale),
                                            radius + 2 * box_padding, monitor);

  leaves.reserve(leaf_count);
  last_leaf = static_cast<std::uint32_t>(leaf_count - 1);
  no_start_node = static_cast<std::uint32_t>((leaf_count + kArity - 1) / kArity);
  start_nodes = base::PackedArray(id_count, no_start_node);
  if (own_radii) radii.reserve(leaf_count);
  std::vector<Bounds> below;
  below.reserve(leaf_count);
  const auto make_leaves = [&](const Range& range) {
    for (std::size_t l = range.begin(); l < range.end(); ++l) {
      const std::size_t n = count_in(static_cast<std::uint32_t>(l));
      const SphereItem* const in_leaf = &items[l * kArity];
      leaves[l] = make_leaf(in_leaf, n);
      float r[kArity], most = 0;
      for (std::size_t i = 0; i < n; ++i) {
        start_nodes.set(in_leaf[i].id, static_cast<std::uint32_t>(l / kArity));
        r[i] = own_radii ? rounded_up(spheres[in_leaf[i].id].radius * frame.scale) : radius;
        most = std::max(most, r[i]);
        float lower[3], upper[3];
        for (int axis = 0; axis < 3; ++axis) {
          lower[axis] = in_leaf[i].center[axis] - (r[i] + box_padding);
          upper[axis] = in_leaf[i].center[axis] + (r[i] + box_padding);
        }
        below[l].add(lower, upper);
      }
      if (!own_radii) continue;
      radii[l].step = step_between(0, most);
      for (std::size_t i = 0; i < n; ++i) radii[l].radius[i] = code_above(r[i], 0, radii[l].step);
    }
  };
  // Leaves replace items step by step, so that both are never in memory completely.
  for (std::size_t begin = 0; begin < leaf_count; begin += kReleasedLeaves) {
    stop.check();
    const std::size_t end = std::min(leaf_count, begin + kReleasedLeaves);
    leaves.resize(end);
    if (own_radii) radii.resize(end);
    below.resize(end);
    tbb::parallel_for(Range(begin, end, 256), make_leaves);
    release(&items[begin * kArity], &items[0] + std::min(count, end * kArity));
  }
  storage.reset();

  std::uint32_t first = 0;
  std::size_t level = 0;
  for (bool of_leaves = true; of_leaves || below.size() > 1; of_leaves = false) {
    const std::size_t parents = (below.size() + kArity - 1) / kArity, begin = nodes.size();
    std::vector<Bounds> above(parents);
    nodes.resize(begin + parents);
    tbb::parallel_for(Range(0, parents, 64), [&](const Range& range) {
      for (std::size_t p = range.begin(); p < range.end(); ++p) {
        const std::size_t n = std::min<std::size_t>(kArity, below.size() - p * kArity);
        const auto child = static_cast<std::uint32_t>(first + p * kArity);
        nodes[begin + p] = make_node(&below[p * kArity], n, of_leaves ? child | kLeafBit : child);
        for (std::size_t i = 0; i < n; ++i) above[p].add(below[p * kArity + i]);
      }
    });
    cells.insert(cells.end(), node_cells[level].begin(), node_cells[level].end());
    level_begin[level++] = first = static_cast<std::uint32_t>(begin);
    below = std::move(above);
  }
  std::copy_n(below[0].lower, 3, box.lower);
  std::copy_n(below[0].upper, 3, box.upper);
}

std::size_t SphereBvh::bytes() const noexcept {
  return start_nodes.bytes() + cells.size() * sizeof(Cell) + leaves.size() * sizeof(Leaf) +
         radii.size() * sizeof(LeafRadii) + nodes.size() * sizeof(Node);
}

}  // namespace orrery::accel
