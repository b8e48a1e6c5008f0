// SPDX-License-Identifier: Apache-2.0
#include "accel/sphere_bvh.h"

#include <hwy/highway.h>
#include <sys/mman.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

#include "base/error.h"

namespace orrery::accel {
namespace {

constexpr std::size_t kArity = SphereBvh::kArity;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Padding in units of the frame's reach. Derived in docs/decisions/0027-bvh-for-many-spheres.md: rounding moves a
/// ray by at most 40 x 2^-24 relative to a sphere and by at most 19 x 2^-24 relative to a box.
constexpr double kSpherePadding = 0x1.4p-17, kBoxPadding = 0x1p-18;

/// Ranges larger than this are binned from a sample.
constexpr std::size_t kSampleSize = 1 << 14;

/// Ranges larger than this are divided between threads.
constexpr std::size_t kParallelSize = 1 << 14;

constexpr int kBins = 32;

/// Ranges up to this size have few bins: what is done once per bin would take longer than what is done per sphere.
constexpr std::size_t kSmallRange = 512;
constexpr int kFewBins = 16;

/// Leaves that are made before the memory of their items is released.
constexpr std::size_t kReleasedLeaves = 1 << 16;

/// A sphere while the tree is built.
struct Item {
  float center[3];  ///< box space
  std::uint32_t id;
};

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

float rounded_up(double x) {
  const auto f = static_cast<float>(x);
  return static_cast<double>(f) < x ? std::nextafter(f, kInfinity) : f;
}

namespace hn = hwy::HWY_NAMESPACE;
using Four = hn::FixedTag<float, 4>;
constexpr Four kFour;

/// Bounds and number of the centres in one bin.
struct alignas(16) Bin {
  float lower[4] = {kInfinity, kInfinity, kInfinity, kInfinity};
  float upper[4] = {-kInfinity, -kInfinity, -kInfinity, -kInfinity};
  std::size_t count = 0;

  void add(hn::Vec<Four> low, hn::Vec<Four> high, std::size_t more) {
    hn::Store(hn::Min(hn::Load(kFour, lower), low), kFour, lower);
    hn::Store(hn::Max(hn::Load(kFour, upper), high), kFour, upper);
    count += more;
  }
  void add(const Bin& b) { add(hn::Load(kFour, b.lower), hn::Load(kFour, b.upper), b.count); }
  /// Half the surface area after growth by `margin` on all sides.
  float area(float margin) const {
    const float x = upper[0] - lower[0] + 2 * margin, y = upper[1] - lower[1] + 2 * margin,
                z = upper[2] - lower[2] + 2 * margin;
    return x * y + y * z + z * x;
  }
};

/// Where to divide a range: the first `left` items along `axis`, which is about where their coordinate is `at`.
struct Split {
  int axis = 0;
  float at = 0;
  std::size_t left = 0;
};

using Cell = SphereBvh::Cell;

/// Returns memory to the operating system. The items are zero from then on.
void release(Item* begin, Item* end) {
  const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
  const auto first = (reinterpret_cast<std::uintptr_t>(begin) + page - 1) / page * page,
             last = reinterpret_cast<std::uintptr_t>(end) / page * page;
  if (first < last) madvise(reinterpret_cast<void*>(first), last - first, MADV_DONTNEED);
}

class Builder {
 public:
  /// `margin`  average radius, for the surface area
  /// `reach`   distance from a centre that its sphere does not exceed, padded
  Builder(std::vector<Item>& items, float margin, float reach, const std::function<bool(double)>& monitor)
      : items_(items), margin_(margin), reach_(reach), monitor_(monitor) {}

  /// The nodes' cells by level, those above the leaves first.
  std::array<std::vector<Cell>, SphereBvh::kMaxDepth> cells;

  /// Sorts all items into the order of the leaves.
  void sort() {
    std::size_t unit = kArity;
    while (unit * kArity < items_.size()) unit *= kArity;
    std::size_t level_unit = kArity * kArity;
    for (std::vector<Cell>& level : cells) {
      level.resize((items_.size() + level_unit - 1) / level_unit);
      level_unit *= kArity;
      if (level.size() == 1) break;
    }
    divide(0, items_.size(), unit * kArity, {{-kInfinity, -kInfinity, -kInfinity}, {kInfinity, kInfinity, kInfinity}});
    if (stopped_) throw base::Error(base::ErrorKind::kStopped, "stopped while building");
  }

 private:
  /// Orders a range so that each subtree of `unit` spheres is contiguous, by binary splits at multiples of `unit`
  /// chosen by the surface area heuristic; then each of these.
  void divide(std::size_t begin, std::size_t end, std::size_t unit, Cell cell) {
    if (stopped_.load(std::memory_order_relaxed)) return;
    for (; end - begin <= unit && unit > kArity; unit /= kArity) {
      // The range is one node.
      std::size_t level = 0;
      for (std::size_t u = kArity * kArity; u < unit; u *= kArity) ++level;
      if (begin / unit < cells[level].size()) cells[level][begin / unit] = cell;
    }
    if (end - begin <= unit) {
      report(end - begin);
      return;
    }
    const Split split = best_split(begin, end, unit);
    const auto first = items_.begin() + static_cast<std::ptrdiff_t>(begin),
               last = items_.begin() + static_cast<std::ptrdiff_t>(end);
    const auto middle = first + static_cast<std::ptrdiff_t>(split.left);
    const int axis = split.axis;
    // A partition at the chosen coordinate is quick; only the part in which the rank lies needs a selection.
    const auto cut = std::partition(first, last, [&](const Item& i) { return i.center[axis] < split.at; });
    const auto by_axis = [axis](const Item& a, const Item& b) { return a.center[axis] < b.center[axis]; };
    if (cut > middle) std::nth_element(first, middle, cut, by_axis);
    if (cut < middle) std::nth_element(cut, middle, last, by_axis);
    const std::size_t at = begin + split.left;
    // No centre on the left is beyond the plane, and none on the right before it.
    const float plane = cut == middle ? split.at : middle->center[axis];
    Cell left = cell, right = cell;
    left.upper[axis] = std::min(left.upper[axis], plane - reach_);
    right.lower[axis] = std::max(right.lower[axis], plane + reach_);
    if (end - begin > kParallelSize) {
      tbb::parallel_invoke([&] { divide(begin, at, unit, left); }, [&] { divide(at, end, unit, right); });
    } else {
      divide(begin, at, unit, left);
      divide(at, end, unit, right);
    }
  }

  Split best_split(std::size_t begin, std::size_t end, std::size_t unit) const {
    const std::size_t count = end - begin, stride = std::max<std::size_t>(1, count / kSampleSize);
    const int bin_count = count <= kSmallRange ? kFewBins : kBins;
    // The fourth lane is an item's id, and is ignored.
    auto low = hn::Set(kFour, kInfinity), high = hn::Set(kFour, -kInfinity);
    for (std::size_t i = begin; i < end; i += stride) {
      const auto center = hn::LoadU(kFour, items_[i].center);
      low = hn::Min(low, center);
      high = hn::Max(high, center);
    }
    alignas(16) float lower[4], upper[4], per_width[4] = {0, 0, 0, 0};
    hn::Store(low, kFour, lower);
    hn::Store(high, kFour, upper);
    for (int axis = 0; axis < 3; ++axis) {
      const float width = upper[axis] - lower[axis];
      per_width[axis] = width > 0 ? static_cast<float>(bin_count) * (1 - 0x1p-20F) / width : 0;
    }
    Bin bins[3][kBins];
    const auto factors = hn::Load(kFour, per_width);
    const auto last = hn::Set(hn::RebindToSigned<Four>(), bin_count - 1);
    for (std::size_t i = begin; i < end; i += stride) {
      const auto center = hn::LoadU(kFour, items_[i].center);
      alignas(16) std::int32_t at[4];
      const auto bin_of = hn::ConvertTo(hn::RebindToSigned<Four>(), (center - low) * factors);
      hn::Store(hn::Max(hn::Min(bin_of, last), hn::Zero(hn::RebindToSigned<Four>())), hn::RebindToSigned<Four>(), at);
      for (int axis = 0; axis < 3; ++axis) bins[axis][at[axis]].add(center, center, 1);
    }
    const std::size_t units = (count + unit - 1) / unit, sampled = (count + stride - 1) / stride;
    const float items_per_sample = static_cast<float>(count) / static_cast<float>(sampled);
    Split best;
    float least = kInfinity;
    for (int axis = 0; axis < 3; ++axis) {
      if (per_width[axis] == 0) continue;
      float right_area[kBins];
      Bin right, left;
      for (int b = bin_count; b-- > 1;) {
        right.add(bins[axis][b]);
        right_area[b] = right.area(margin_);
      }
      for (int b = 1; b < bin_count; ++b) {
        left.add(bins[axis][b - 1]);
        if (left.count == 0) continue;
        if (left.count == sampled) break;
        // The split is moved to the next multiple of the unit, which makes it worse the further it moves.
        const float wanted = static_cast<float>(left.count) * items_per_sample / static_cast<float>(unit);
        const auto left_units = std::clamp<std::size_t>(static_cast<std::size_t>(wanted + 0.5F), 1, units - 1);
        const float moved = std::abs(static_cast<float>(left_units) - wanted) / static_cast<float>(units);
        const float cost = (left.area(margin_) * static_cast<float>(left_units) +
                            right_area[b] * static_cast<float>(units - left_units)) *
                           (1 + moved);
        if (cost < least) {
          least = cost;
          best = {axis, lower[axis] + static_cast<float>(b) / per_width[axis], left_units * unit};
        }
      }
    }
    if (least == kInfinity) best.left = units / 2 * unit;  // all centres coincide
    return best;
  }

  void report(std::size_t count) {
    if (!monitor_) return;
    const std::size_t done = done_.fetch_add(count, std::memory_order_relaxed) + count;
    // About a thousand calls in all.
    const std::size_t step = items_.size() / 1024 + 1;
    if (done / step != (done - count) / step &&
        !monitor_(static_cast<double>(done) / static_cast<double>(items_.size())))
      stopped_ = true;
  }

  std::vector<Item>& items_;
  float margin_, reach_;
  const std::function<bool(double)>& monitor_;
  std::atomic<std::size_t> done_{0};
  std::atomic<bool> stopped_{false};
};

/// A code whose decoded bound is at most `bound`, and one whose is at least `bound`.
///
/// Domain     `bound` is between origin and what code 255 stands for
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
    for (std::size_t i = 0; i < count; ++i) {
      node.bound[0][axis][i] = code_below(children[i].lower[axis], origin, step);
      node.bound[1][axis][i] = code_above(children[i].upper[axis], origin, step);
    }
  }
  return node;
}

SphereBvh::Leaf make_leaf(const Item* items, std::size_t count) {
  Bounds all;
  for (std::size_t i = 0; i < count; ++i) all.add(items[i].center, items[i].center);
  SphereBvh::Leaf leaf{};
  leaf.step = 0;
  for (int axis = 0; axis < 3; ++axis) {
    leaf.origin[axis] = all.lower[axis];
    leaf.step = std::max(leaf.step, step_between(all.lower[axis], all.upper[axis]));
  }
  for (std::size_t i = 0; i < count; ++i)
    for (int axis = 0; axis < 3; ++axis)
      leaf.center[axis][i] = static_cast<std::uint8_t>(
          std::clamp(std::lround((items[i].center[axis] - leaf.origin[axis]) / leaf.step), 0L, 255L));
  return leaf;
}

}  // namespace

SphereBvh::SphereBvh(const kernel::SphereArray& spheres, std::vector<std::uint32_t> all, const BoxFrame& frame,
                     const std::function<bool(double)>& monitor)
    : count(all.size()), ids(std::move(all)) {
  using Range = tbb::blocked_range<std::size_t>;
  const std::size_t leaf_count = (count + kArity - 1) / kArity;
  padding = rounded_up(kSpherePadding * frame.reach);
  double smallest = std::numeric_limits<double>::infinity(), largest = 0, sum = 0;
  for (const std::uint32_t id : ids) {
    const double r = spheres[id].radius;
    smallest = std::min(smallest, r);
    largest = std::max(largest, r);
    sum += r;
  }
  const bool own_radii = smallest < largest;
  radius = rounded_up(largest * frame.scale);
  const std::size_t id_count = std::size_t{*std::max_element(ids.begin(), ids.end())} + 1;

  std::vector<Item> items(count);
  tbb::parallel_for(Range(0, count, 4096), [&](const Range& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      const kernel::Sphere s = spheres[ids[i]];
      items[i] = {{static_cast<float>((s.x - frame.middle[0]) * frame.scale),
                   static_cast<float>((s.y - frame.middle[1]) * frame.scale),
                   static_cast<float>((s.z - frame.middle[2]) * frame.scale)},
                  ids[i]};
    }
  });
  std::vector<std::uint32_t>().swap(ids);  // they are in the items
  const float box_padding = rounded_up(kBoxPadding * frame.reach);
  Builder builder(items, static_cast<float>(sum / static_cast<double>(count) * frame.scale), radius + 2 * box_padding,
                  monitor);
  builder.sort();

  leaves.reserve(leaf_count);
  last_leaf = static_cast<std::uint32_t>(leaf_count - 1);
  places.assign(id_count, kernel::kNoSphere);
  ids.reserve(leaf_count * kArity);
  if (own_radii) radii.reserve(leaf_count);
  std::vector<Bounds> below;
  below.reserve(leaf_count);
  const auto make_leaves = [&](const Range& range) {
    for (std::size_t l = range.begin(); l < range.end(); ++l) {
      const std::size_t n = count_in(static_cast<std::uint32_t>(l));
      const Item* const in_leaf = &items[l * kArity];
      leaves[l] = make_leaf(in_leaf, n);
      float r[kArity], most = 0;
      for (std::size_t i = 0; i < n; ++i) {
        ids[l * kArity + i] = in_leaf[i].id;
        places[in_leaf[i].id] = static_cast<std::uint32_t>(l * kArity + i);
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
  // Leaves take the place of items, so that memory is never needed for all of both.
  for (std::size_t begin = 0; begin < leaf_count; begin += kReleasedLeaves) {
    const std::size_t end = std::min(leaf_count, begin + kReleasedLeaves);
    leaves.resize(end);
    ids.resize(end * kArity, kernel::kNoSphere);
    if (own_radii) radii.resize(end);
    below.resize(end);
    tbb::parallel_for(Range(begin, end, 256), make_leaves);
    release(&items[begin * kArity], &items[0] + std::min(count, end * kArity));
  }
  std::vector<Item>().swap(items);

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
    cells.insert(cells.end(), builder.cells[level].begin(), builder.cells[level].end());
    level_begin[level++] = first = static_cast<std::uint32_t>(begin);
    below = std::move(above);
  }
  std::copy_n(below[0].lower, 3, box.lower);
  std::copy_n(below[0].upper, 3, box.upper);
}

std::size_t SphereBvh::bytes() const noexcept {
  return (ids.size() + places.size()) * sizeof(ids[0]) + cells.size() * sizeof(Cell) + leaves.size() * sizeof(Leaf) +
         radii.size() * sizeof(LeafRadii) + nodes.size() * sizeof(Node);
}

}  // namespace orrery::accel
