// SPDX-License-Identifier: Apache-2.0
#include "accel/sphere_sort.h"

#include <hwy/cache_control.h>
#include <hwy/highway.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <utility>

#include "base/error.h"
#include "base/stop_point.h"

namespace orrery::accel {
namespace {

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

/// What sorting needs to know of spheres that are in memory with their centres.
struct DirectItems {
  using Item = SphereItem;

  float coordinate(const Item& item, int axis) const { return item.center[axis]; }
  /// The centre, and 0 instead of the id: as a float the id would be subnormal, which costs some processors a hundred
  /// cycles.
  hn::Vec<Four> center(const Item& item) const {
    alignas(16) static constexpr std::uint32_t kThree[4] = {~0u, ~0u, ~0u, 0};
    return hn::And(hn::LoadU(kFour, item.center), hn::BitCast(kFour, hn::Load(hn::RebindToUnsigned<Four>(), kThree)));
  }
  void prefetch(const Item*, const Item*) const {}
  static void swap(Item* a, Item* b) {
    // All four lanes: the centre and the id.
    const auto moved = hn::LoadU(kFour, b->center);
    hn::StoreU(hn::LoadU(kFour, a->center), kFour, b->center);
    hn::StoreU(moved, kFour, a->center);
  }
};

/// The same of ids, whose spheres are elsewhere.
struct IndirectItems {
  using Item = std::uint32_t;

  const EnclosingSpheres& spheres;

  float coordinate(Item id, int axis) const { return spheres.coordinate(id, axis); }
  hn::Vec<Four> center(Item id) const { return DirectItems().center(spheres.item(id)); }
  /// Fetches the sphere of an item that is needed soon.
  void prefetch(const Item* item, const Item* last) const {
    constexpr std::ptrdiff_t kAhead = 16;
    if (last - item <= kAhead) return;
    if (const Item id = item[kAhead]; !spheres.rods.rods.contains(id))
      hwy::Prefetch(spheres.spheres.spheres.address(id));
  }
  static void swap(Item* a, Item* b) { std::swap(*a, *b); }
};

/// Moves the items before a plane to the front, in any order. Branchless, because a branch would be mispredicted for
/// half of the items.
///
/// Result     the first of the other items
template <class Items>
typename Items::Item* partition(const Items& items, typename Items::Item* first, typename Items::Item* last, int axis,
                                float at) {
  for (auto* item = first; item != last; ++item) {
    items.prefetch(item, last);
    const bool is_before = items.coordinate(*item, axis) < at;
    items.swap(first, item);
    first += is_before;
  }
  return first;
}

/// Orders items like std::nth_element for `middle`; fast if the split's estimate is good.
///
/// Result     the coordinate of the division: no item on the left is beyond it, none on the right before it
template <class Items>
float divide_at(const Items& items, std::span<typename Items::Item> range, const Split& split) {
  auto *const first = range.data(), *const middle = first + split.left, *const last = first + range.size();
  auto* const cut = partition(items, first, last, split.axis, split.at);
  if (cut == middle) return split.at;
  // Few items are between the estimate and the requested rank: a second plane separates most of the others.
  auto *begin = first, *end = last;
  if (cut < middle) {
    begin = cut;
    auto* const beyond = partition(items, cut, last, split.axis, split.at + split.spread);
    (beyond > middle ? end : begin) = beyond;
  } else {
    end = cut;
    auto* const before = partition(items, first, cut, split.axis, split.at - split.spread);
    (before > middle ? end : begin) = before;
  }
  std::nth_element(begin, middle, end, [&](const auto& a, const auto& b) {
    return items.coordinate(a, split.axis) < items.coordinate(b, split.axis);
  });
  return items.coordinate(*middle, split.axis);
}

/// The split of a range into two parts by the surface area heuristic, with a multiple of `unit` items on the left.
template <class Items>
Split best_split(const Items& items, std::span<const typename Items::Item> range, std::size_t unit, float margin) {
  const std::size_t count = range.size(), stride = std::max<std::size_t>(1, count / kSampleSize);
  auto low = hn::Set(kFour, kInfinity), high = hn::Set(kFour, -kInfinity);
  for (std::size_t i = 0; i < count; i += stride) {
    const auto center = items.center(range[i]);
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
  for (std::size_t i = 0; i < count; i += stride) {
    const auto center = items.center(range[i]);
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
      right_area[b] = right.area(margin);
    }
    for (int b = 1; b < bin_count; ++b) {
      left.add(bins[axis][b - 1]);
      if (left.count == 0) continue;
      if (left.count == sampled) break;
      // The split is moved to the next multiple of the unit; the farther it moves, the worse it gets.
      const float wanted = static_cast<float>(left.count) * units_per_sample;
      const auto left_units = std::clamp<std::size_t>(static_cast<std::size_t>(wanted + 0.5F), 1, units - 1);
      const float moved = static_cast<float>(left_units) - wanted;
      const float cost = (left.area(margin) * static_cast<float>(left_units) +
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

}  // namespace

SphereSort::SphereSort(std::size_t count, std::size_t part_size, float margin, float reach, const Monitor& monitor)
    : count_(count), part_size_(part_size), margin_(margin), reach_(reach), monitor_(monitor) {
  std::size_t level_unit = kArity * kArity;
  for (std::vector<Cell>& level : cells_) {
    level.resize((count + level_unit - 1) / level_unit);
    level_unit *= kArity;
    if (level.size() == 1) break;
  }
}

std::vector<SphereSort::Part> SphereSort::divide(const EnclosingSpheres& spheres, std::span<std::uint32_t> ids) {
  std::size_t unit = kArity * kArity;
  while (unit < ids.size()) unit *= kArity;
  constexpr Cell kEverywhere = {{-kInfinity, -kInfinity, -kInfinity, -kInfinity},
                                {kInfinity, kInfinity, kInfinity, kInfinity}};
  std::vector<Part> parts;
  divide(IndirectItems{spheres}, ids, {0, ids.size(), unit, kEverywhere}, &parts);
  throw_if_stopped();
  return parts;
}

void SphereSort::sort(const Part& part, std::span<SphereItem> items) {
  divide(DirectItems(), items, part, nullptr);
  throw_if_stopped();
}

/// Orders a range so that each subtree of part.unit spheres is contiguous, by binary splits at multiples of the unit
/// chosen by the surface area heuristic; then each of these.
///
/// `parts`    receives ranges that are small enough; null: there are none, everything is sorted
template <class Items>
void SphereSort::divide(const Items& items, std::span<typename Items::Item> range, Part part,
                        std::vector<Part>* parts) {
  if (stopped_.load(std::memory_order_relaxed)) return;
  stop_.check();
  if (parts != nullptr && part.count <= part_size_) {
    parts->push_back(part);
    return;
  }
  if (parts != nullptr && monitor_ && !monitor_(0)) stopped_ = true;
  for (; part.count <= part.unit && part.unit > kArity; part.unit /= kArity) {
    // The range is one node.
    std::size_t level = 0;
    for (std::size_t u = kArity * kArity; u < part.unit; u *= kArity) ++level;
    if (part.begin / part.unit < cells_[level].size()) cells_[level][part.begin / part.unit] = part.cell;
  }
  if (part.count <= part.unit) {
    report(part.count);
    return;
  }
  const Split split = best_split<Items>(items, range, part.unit, margin_);
  stop_.check();
  const float plane = divide_at(items, range, split);
  Part left = part, right = part;
  left.count = split.left;
  right.begin += split.left;
  right.count -= split.left;
  left.cell.upper[split.axis] = std::min(left.cell.upper[split.axis], plane - reach_);
  right.cell.lower[split.axis] = std::max(right.cell.lower[split.axis], plane + reach_);
  std::vector<Part> of_right;
  const auto divide_left = [&] { divide(items, range.first(split.left), left, parts); };
  const auto divide_right = [&] {
    divide(items, range.subspan(split.left), right, parts != nullptr ? &of_right : nullptr);
  };
  if (part.count > kParallelSize) {
    tbb::parallel_invoke(divide_left, divide_right);
  } else {
    divide_left();
    divide_right();
  }
  if (parts != nullptr) parts->insert(parts->end(), of_right.begin(), of_right.end());
}

void SphereSort::report(std::size_t count) {
  if (!monitor_) return;
  const std::size_t done = done_.fetch_add(count, std::memory_order_relaxed) + count;
  // About a thousand calls in all.
  const std::size_t step = count_ / 1024 + 1;
  if (done / step != (done - count) / step && !monitor_(static_cast<double>(done) / static_cast<double>(count_)))
    stopped_ = true;
}

void SphereSort::throw_if_stopped() const {
  if (stopped_) throw base::Error(base::ErrorKind::kStopped, "stopped while building");
}

}  // namespace orrery::accel
