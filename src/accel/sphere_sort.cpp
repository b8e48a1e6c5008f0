// SPDX-License-Identifier: Apache-2.0
#include "accel/sphere_bvh.h"

#include <hwy/highway.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "base/error.h"
#include "base/stop_point.h"

namespace orrery::accel {
namespace {

using Item = SphereItem;
using Cell = SphereBvh::Cell;

/// Ranges larger than this are binned from a sample.
constexpr std::size_t kSampleSize = 1 << 11;

/// Ranges larger than this are divided between threads.
constexpr std::size_t kParallelSize = 1 << 14;

constexpr int kBins = 32;

/// Ranges up to this size have few bins, because the work per bin would exceed the work per sphere.
constexpr std::size_t kSmallRange = 512;
constexpr int kFewBins = 16;

namespace hn = hwy::HWY_NAMESPACE;
using Four = hn::FixedTag<float, 4>;
constexpr Four kFour;

/// An item's centre, and 0 instead of its id: as a float the id would be subnormal, which costs some processors a
/// hundred cycles.
hn::Vec<Four> center_of(const Item& item) {
  alignas(16) static constexpr std::uint32_t kThree[4] = {~0u, ~0u, ~0u, 0};
  return hn::And(hn::LoadU(kFour, item.center), hn::BitCast(kFour, hn::Load(hn::RebindToUnsigned<Four>(), kThree)));
}

/// Bounds and number of the centres in one bin.
struct alignas(16) Bin {
  float lower[4], upper[4];
  std::size_t count;

  static Bin empty() {
    return {{kInfinity, kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity, -kInfinity}, 0};
  }

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

/// Where to divide a range: the first `left` items along `axis`.
struct Split {
  int axis = 0;
  std::size_t left = 0;
  float at = 0;      ///< an estimate of the coordinate of that division
  float spread = 0;  ///< its uncertainty; larger values are slower
};

/// Moves the items before a plane to the front, in any order. Branchless, because a branch would be mispredicted for
/// half of the items.
///
/// Result     the first of the other items
Item* partition(Item* first, Item* last, int axis, float at) {
  for (Item* item = first; item != last; ++item) {
    const bool is_before = item->center[axis] < at;
    // All four lanes: the centre and the id.
    const auto moved = hn::LoadU(kFour, item->center);
    hn::StoreU(hn::LoadU(kFour, first->center), kFour, item->center);
    hn::StoreU(moved, kFour, first->center);
    first += is_before;
  }
  return first;
}

/// Orders items like std::nth_element for `middle`; fast if the split's estimate is good.
///
/// Result     the coordinate of the division: no item on the left is beyond it, none on the right before it
float divide_at(Item* first, Item* middle, Item* last, const Split& split) {
  Item* const cut = partition(first, last, split.axis, split.at);
  if (cut == middle) return split.at;
  // Few items are between the estimate and the requested rank: a second plane separates most of the others.
  Item *begin = first, *end = last;
  if (cut < middle) {
    begin = cut;
    Item* const beyond = partition(cut, last, split.axis, split.at + split.spread);
    (beyond > middle ? end : begin) = beyond;
  } else {
    end = cut;
    Item* const before = partition(first, cut, split.axis, split.at - split.spread);
    (before > middle ? end : begin) = before;
  }
  std::nth_element(begin, middle, end,
                   [&](const Item& a, const Item& b) { return a.center[split.axis] < b.center[split.axis]; });
  return middle->center[split.axis];
}

class Sorter {
 public:
  Sorter(std::span<Item> items, float margin, float reach, const std::function<bool(double)>& monitor)
      : items_(items), margin_(margin), reach_(reach), monitor_(monitor) {}

  NodeCells cells;

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
    divide(0, items_.size(), unit * kArity,
           {{-kInfinity, -kInfinity, -kInfinity, -kInfinity}, {kInfinity, kInfinity, kInfinity, kInfinity}});
    if (stopped_) throw base::Error(base::ErrorKind::kStopped, "stopped while building");
  }

 private:
  /// Orders a range so that each subtree of `unit` spheres is contiguous, by binary splits at multiples of `unit`
  /// chosen by the surface area heuristic; then each of these.
  void divide(std::size_t begin, std::size_t end, std::size_t unit, Cell cell) {
    if (stopped_.load(std::memory_order_relaxed)) return;
    stop_.check();
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
    stop_.check();
    const std::size_t at = begin + split.left;
    const int axis = split.axis;
    const float plane = divide_at(&items_[begin], &items_[at], &items_[0] + end, split);
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

  /// The split of a range into two parts by the surface area heuristic, with a multiple of `unit` items on the left.
  Split best_split(std::size_t begin, std::size_t end, std::size_t unit) const {
    const std::size_t count = end - begin, stride = std::max<std::size_t>(1, count / kSampleSize);
    auto low = hn::Set(kFour, kInfinity), high = hn::Set(kFour, -kInfinity);
    for (std::size_t i = begin; i < end; i += stride) {
      const auto center = center_of(items_[i]);
      low = hn::Min(low, center);
      high = hn::Max(high, center);
    }
    alignas(16) float lower[4], width[4];
    hn::Store(low, kFour, lower);
    hn::Store(high - low, kFour, width);
    if (count <= 2 * unit) {
      // There is one split along each axis. That of the longest is nearly always the best.
      const int axis = static_cast<int>(std::max_element(width, width + 3) - width);
      return {axis, unit, lower[axis] + width[axis] * static_cast<float>(unit) / static_cast<float>(count),
              width[axis] / 8};
    }

    const int bin_count = count <= kSmallRange ? kFewBins : kBins;
    Bin bins[3][kBins];
    alignas(16) float per_width[4] = {0, 0, 0, 0};
    for (int axis = 0; axis < 3; ++axis) {
      if (width[axis] > 0) per_width[axis] = static_cast<float>(bin_count) * (1 - 0x1p-20F) / width[axis];
      std::fill_n(bins[axis], bin_count, Bin::empty());
    }
    const auto factors = hn::Load(kFour, per_width);
    const auto last = hn::Set(hn::RebindToSigned<Four>(), bin_count - 1);
    for (std::size_t i = begin; i < end; i += stride) {
      const auto center = center_of(items_[i]);
      alignas(16) std::int32_t at[4];
      const auto bin_of = hn::ConvertTo(hn::RebindToSigned<Four>(), (center - low) * factors);
      hn::Store(hn::Max(hn::Min(bin_of, last), hn::Zero(hn::RebindToSigned<Four>())), hn::RebindToSigned<Four>(), at);
      for (int axis = 0; axis < 3; ++axis) bins[axis][at[axis]].add(center, center, 1);
    }

    const std::size_t units = (count + unit - 1) / unit, sampled = (count + stride - 1) / stride;
    const float units_per_sample = static_cast<float>(count) / (static_cast<float>(sampled) * static_cast<float>(unit));
    Split best;
    float least = kInfinity;
    for (int axis = 0; axis < 3; ++axis) {
      if (per_width[axis] == 0) continue;
      float right_area[kBins];
      Bin right = Bin::empty(), left = Bin::empty();
      for (int b = bin_count; b-- > 1;) {
        right.add(bins[axis][b]);
        right_area[b] = right.area(margin_);
      }
      for (int b = 1; b < bin_count; ++b) {
        left.add(bins[axis][b - 1]);
        if (left.count == 0) continue;
        if (left.count == sampled) break;
        // The split is moved to the next multiple of the unit; the farther it moves, the worse it gets.
        const float wanted = static_cast<float>(left.count) * units_per_sample;
        const auto left_units = std::clamp<std::size_t>(static_cast<std::size_t>(wanted + 0.5F), 1, units - 1);
        const float moved = static_cast<float>(left_units) - wanted;
        const float cost = (left.area(margin_) * static_cast<float>(left_units) +
                            right_area[b] * static_cast<float>(units - left_units)) *
                           (1 + std::abs(moved) / static_cast<float>(units));
        if (cost < least) {
          least = cost;
          // Centres are assumed to be evenly distributed within the bin into which the split moves.
          const std::size_t in_bin = bins[axis][moved > 0 ? b : b - 1].count;
          const float bins_moved =
              std::clamp(moved / std::max(static_cast<float>(in_bin) * units_per_sample, 0x1p-20F), -1.0F, 1.0F);
          best = {axis, left_units * unit, lower[axis] + (static_cast<float>(b) + bins_moved) / per_width[axis],
                  0.5F / per_width[axis]};
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

  std::span<Item> items_;
  float margin_, reach_;
  const std::function<bool(double)>& monitor_;
  std::atomic<std::size_t> done_{0};
  std::atomic<bool> stopped_{false};
  base::StopPoint stop_;
};

}  // namespace

NodeCells sort_spheres(std::span<SphereItem> items, float margin, float reach,
                       const std::function<bool(double)>& monitor) {
  Sorter sorter(items, margin, reach, monitor);
  sorter.sort();
  return std::move(sorter.cells);
}

}  // namespace orrery::accel
