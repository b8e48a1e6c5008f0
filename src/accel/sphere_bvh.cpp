// SPDX-License-Identifier: Apache-2.0
#include "accel/sphere_bvh.h"

#include <hwy/cache_control.h>
#include <hwy/highway.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "accel/box_frame.h"
#include "accel/sphere_codes.h"
#include "base/error.h"
#include "base/huge_pages.h"
#include "base/parallel.h"
#include "base/stop_point.h"
#include "math/scalar.h"

namespace orrery::accel {
namespace {

using math::rounded_up;

/// Padding in units of the frame's reach. Derived in docs/decisions/0027-bvh-for-many-spheres.md: rounding moves a
/// ray by at most 40 x 2^-24 relative to a sphere and by at most 19 x 2^-24 relative to a box.
constexpr double kSpherePadding = 0x1.4p-17, kBoxPadding = 0x1p-18;

/// Rounding error of the triple product of a ray's direction, the half axis of a rod, and the vector between them, in
/// units of the frame's reach times the length of the half axis: at most 8 x 2^-24 of that vector, whose length is at
/// most 2.5 reaches. The half axis is at most sqrt(3) x 127 steps long.
constexpr double kAxisSlack = 0x1p-18 * 1.7321 * kLargestHalfCode;

/// The spheres that enclose the spheres and rods of a scene, by id.
struct EnclosingSpheres {
  BoundedSpheres spheres;
  BoundedRods rods;
  BoxFrame frame;

  /// World space.
  kernel::Sphere operator[](std::uint32_t id) const noexcept {
    return rods.rods.contains(id) ? enclosing_sphere(rods.at(rods.rods.index(id), 0)) : enclosing_sphere(spheres, id);
  }
  /// The largest radius of a sphere while the shutter is open, or that of the sphere around a rod.
  double radius(std::uint32_t id) const noexcept {
    return id < spheres.moving_count ? path_of(spheres, id).radius : (*this)[id].radius;
  }
  /// One coordinate of a centre, box space.
  float coordinate(std::uint32_t id, int axis) const noexcept {
    const auto along = [axis](const kernel::Sphere& s) { return axis == 0 ? s.x : axis == 1 ? s.y : s.z; };
    const auto x = [&] {
      if (rods.rods.contains(id)) return along((*this)[id]);
      const double from = spheres.coordinate(id, axis);
      return id < spheres.moving_count ? from + (from + along(spheres.motion[id]) - from) / 2 : from;
    };
    return static_cast<float>((x() - frame.middle[axis]) * frame.scale);
  }
  SphereItem item(std::uint32_t id) const noexcept {
    return {{coordinate(id, 0), coordinate(id, 1), coordinate(id, 2)}, id};
  }
};

using Cell = SphereBvh::Cell;

/// Ranges larger than this are binned from a sample.
constexpr std::size_t kCentroidSamples = 1 << 11;

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
  /// As std::nth_element.
  void select(Item* begin, Item* middle, Item* end, int axis) const {
    std::nth_element(begin, middle, end,
                     [axis](const Item& a, const Item& b) { return a.center[axis] < b.center[axis]; });
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
    constexpr std::ptrdiff_t kAhead = 64;
    if (last - item <= kAhead) return;
    if (const Item id = item[kAhead]; !spheres.rods.rods.contains(id))
      hwy::Prefetch(spheres.spheres.spheres.address(id));
  }
  static void swap(Item* a, Item* b) { std::swap(*a, *b); }
  /// As std::nth_element, but each sphere is fetched once.
  void select(Item* begin, Item* middle, Item* end, int axis) const {
    std::vector<std::pair<float, Item>> keys(static_cast<std::size_t>(end - begin));
    for (std::size_t i = 0; i < keys.size(); ++i) {
      prefetch(begin + i, end);
      keys[i] = {coordinate(begin[i], axis), begin[i]};
    }
    std::nth_element(keys.begin(), keys.begin() + (middle - begin), keys.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    for (const auto& key : keys) *begin++ = key.second;
  }
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
  items.select(begin, middle, end, split.axis);
  return items.coordinate(*middle, split.axis);
}

/// The split of a range into two parts by the surface area heuristic, with a multiple of `unit` items on the left.
template <class Items>
Split best_split(const Items& items, std::span<const typename Items::Item> range, std::size_t unit, float margin) {
  const std::size_t count = range.size(), stride = std::max<std::size_t>(1, count / kCentroidSamples);
  // The extent of the centres.
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

  // Divide the extent along each axis into bins.
  const int bin_count = count <= kSmallRange ? kFewBins : kBins;
  Bin bins[3][kBins];
  alignas(16) float per_width[4] = {0, 0, 0, 0};
  for (int axis = 0; axis < 3; ++axis) {
    if (width[axis] > 0) per_width[axis] = static_cast<float>(bin_count) * (1 - 0x1p-20F) / width[axis];
    std::fill_n(bins[axis], bin_count, Bin::empty());
  }
  // Add the centres to their bins.
  const auto factors = hn::Load(kFour, per_width);
  const auto last = hn::Set(hn::RebindToSigned<Four>(), bin_count - 1);
  for (std::size_t i = 0; i < count; i += stride) {
    const auto center = items.center(range[i]);
    alignas(16) std::int32_t at[4];
    const auto bin_of = hn::ConvertTo(hn::RebindToSigned<Four>(), (center - low) * factors);
    hn::Store(hn::Max(hn::Min(bin_of, last), hn::Zero(hn::RebindToSigned<Four>())), hn::RebindToSigned<Four>(), at);
    for (int axis = 0; axis < 3; ++axis) bins[axis][at[axis]].add(center, center, 1);
  }

  // Find the cheapest plane between two bins.
  const std::size_t units = (count + unit - 1) / unit, sampled = (count + stride - 1) / stride;
  const float units_per_sample = static_cast<float>(count) / (static_cast<float>(sampled) * static_cast<float>(unit));
  Split best;
  float least = kInfinity;
  for (int axis = 0; axis < 3; ++axis) {
    if (per_width[axis] == 0) continue;
    // Areas of what is right of each plane, then the costs from left to right.
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

/// Sorts spheres into the order of the leaves of a BVH, using the surface area heuristic.
///
/// It takes two stages: items in memory are sorted fastest, but take four times the memory of ids. So divide() sorts
/// ids until the spheres below one node are together, and sort() the items of one such part at a time.
class SphereSort {
 public:
  using Monitor = std::function<bool(double)>;

  /// The spheres below one node.
  struct Part {
    std::size_t begin, count;  ///< place in the order of the leaves
    std::size_t unit;          ///< number of spheres below a child of the node, or more
    SphereBvh::Cell cell;
  };

  /// `count`      number of spheres
  /// `part_size`  most spheres in a part: a power of kArity, at least its square
  /// `margin`     average radius, for the surface area, box space
  /// `reach`      maximum distance of a sphere's surface from its centre, padded, box space
  /// `monitor`    receives the progress, 0..1, on any thread; returns false to cancel; or empty
  SphereSort(std::size_t count, std::size_t part_size, float margin, float reach, const Monitor& monitor);

  /// Sorts ids until each part is contiguous.
  ///
  /// Result     the parts, in the order of their spheres
  /// Errors     base::Error(kStopped) if the monitor or a base::StopScope cancelled; those of sort() too
  std::vector<Part> divide(const EnclosingSpheres& spheres, std::span<std::uint32_t> ids);

  /// Sorts the items of a part.
  void sort(const Part& part, std::span<SphereItem> items);

  /// The cells of the nodes by level, starting with the level above the leaves; complete when all parts are sorted.
  const std::vector<SphereBvh::Cell>& cells(std::size_t level) const { return cells_[level]; }

 private:
  template <class Items>
  void divide(const Items& items, std::span<typename Items::Item> range, Part part, std::vector<Part>* parts);
  void report(std::size_t count);
  void throw_if_stopped() const;

  std::size_t count_, part_size_;
  float margin_, reach_;
  const Monitor& monitor_;
  std::array<std::vector<SphereBvh::Cell>, SphereBvh::kMaxDepth> cells_;
  std::atomic<std::size_t> done_{0};
  std::atomic<bool> stopped_{false};
  base::StopPoint stop_;
};

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

/// Builds a SphereBvh.
class Builder {
 public:
  Builder(SphereBvh& bvh, const EnclosingSpheres& spheres, std::vector<std::uint32_t> ids)
      : bvh_(bvh), spheres_(spheres), ids_(std::move(ids)) {}

  void run(const SphereSort::Monitor& monitor, std::size_t part_size) {
    measure();
    reserve();
    SphereSort sort(bvh_.count, part_size, static_cast<float>(mean_radius_), reach_ + 2 * box_padding_, monitor);
    for (const SphereSort::Part& part : sort.divide(spheres_, ids_)) {
      const std::span<SphereItem> items = take_items(part);
      sort.sort(part, items);
      add_leaves(part, items);
    }
    base::HugeVector<SphereItem>().swap(items_);
    add_nodes(sort);
  }

 private:
  using Range = tbb::blocked_range<std::size_t>;

  /// Determines the radii, and whether there are rods.
  void measure() {
    struct Radii {
      double least = std::numeric_limits<double>::infinity(), largest = 0, sum = 0, spread = 0, reach = 0;
      bool has_rods = false, moves = false;
    };
    const Radii radii = base::accumulate_parallel(
        ids_.size(), Radii(),
        [&](Radii& all, std::size_t i) {
          const std::uint32_t id = ids_[i];
          const double r = spheres_.radius(id);
          all.has_rods = all.has_rods || spheres_.rods.rods.contains(id);
          all.reach = std::max(all.reach, r);
          if (id < spheres_.spheres.moving_count) {
            all.moves = true;
            all.spread = std::max(all.spread, spread_of(id));
            all.reach = std::max(all.reach, spheres_[id].radius);
          }
          all.least = std::min(all.least, r);
          all.largest = std::max(all.largest, r);
          all.sum += r;
        },
        [](Radii& a, const Radii& b) {
          a = {std::min(a.least, b.least),
               std::max(a.largest, b.largest),
               a.sum + b.sum,
               std::max(a.spread, b.spread),
               std::max(a.reach, b.reach),
               a.has_rods || b.has_rods,
               a.moves || b.moves};
        });
    has_rods_ = radii.has_rods;
    own_radii_ = radii.least < radii.largest || has_rods_;
    mean_radius_ = radii.sum / static_cast<double>(ids_.size()) * spheres_.frame.scale;
    bvh_.moves = radii.moves;
    bvh_.radius = rounded_up(radii.largest * spheres_.frame.scale);
    reach_ = rounded_up(radii.reach * spheres_.frame.scale);
    bvh_.spread = rounded_up(radii.spread * spheres_.frame.scale);
    bvh_.padding = rounded_up(kSpherePadding * spheres_.frame.reach);
    bvh_.axis_slack = rounded_up(kAxisSlack * spheres_.frame.reach);
    box_padding_ = rounded_up(kBoxPadding * spheres_.frame.reach);
  }

  /// See SphereBvh::spread.
  double spread_of(std::uint32_t id) const {
    const kernel::Sphere from = spheres_.spheres[id], to = spheres_.spheres.at(id, 1);
    return 2 * (spheres_.radius(id) - std::min(from.radius, to.radius));
  }

  /// Reserves memory, which is touched when it is needed.
  void reserve() {
    const std::size_t leaves = parents_of(bvh_.count);
    std::size_t nodes = 0;
    for (std::size_t level = leaves; level > 1 || nodes == 0; nodes += level) level = parents_of(level);
    bvh_.leaves.reserve(leaves);
    if (own_radii_) bvh_.radii.reserve(leaves);
    if (has_rods_ || bvh_.moves) bvh_.rods.reserve(leaves);
    bvh_.nodes.reserve(nodes);
    bvh_.cells.reserve(nodes);
    above_leaves_.reserve(parents_of(leaves));
    bvh_.last_leaf = static_cast<std::uint32_t>(leaves - 1);
    bvh_.no_start_node = static_cast<std::uint32_t>(parents_of(leaves));
    if (bvh_.count > SphereBvh::kMostStartNodes) return;
    const std::size_t last = spheres_.rods.rods.object(*std::max_element(ids_.begin(), ids_.end()));
    bvh_.start_nodes = base::PackedArray(last + 1, bvh_.no_start_node);
  }

  /// Replaces the ids of a part by items, and returns their memory.
  std::span<SphereItem> take_items(const SphereSort::Part& part) {
    items_.resize(std::max(items_.size(), part.count));
    const std::span items(items_.data(), part.count);
    const std::span<std::uint32_t> ids(&ids_[part.begin], part.count);
    const base::StopPoint stop;
    tbb::parallel_for(Range(0, part.count, 4096), [&](const Range& range) {
      stop.check();
      for (std::size_t i = range.begin(); i < range.end(); ++i) {
        IndirectItems{spheres_}.prefetch(&ids[i], ids.data() + ids.size());
        items[i] = spheres_.item(ids[i]);
      }
    });
    base::release_memory(ids);
    return items;
  }

  /// Adds the leaves of a part and the nodes above them.
  void add_leaves(const SphereSort::Part& part, std::span<const SphereItem> items) {
    const std::size_t first = bvh_.leaves.size(), count = parents_of(part.count), first_node = bvh_.nodes.size();
    bvh_.leaves.resize(first + count);
    if (own_radii_) bvh_.radii.resize(first + count);
    if (has_rods_ || bvh_.moves) bvh_.rods.resize(first + count);
    bvh_.nodes.resize(first_node + parents_of(count));
    above_leaves_.resize(bvh_.nodes.size());
    const base::StopPoint stop;
    tbb::parallel_for(Range(0, parents_of(count), 16), [&](const Range& range) {
      stop.check();
      for (std::size_t n = range.begin(); n < range.end(); ++n) {
        Bounds children[kArity];
        const std::size_t below = n * kArity, here = std::min(kArity, count - below);
        for (std::size_t i = 0; i < here; ++i) {
          const std::size_t begin = (below + i) * kArity;
          children[i] = add_leaf(first + below + i, items.subspan(begin, std::min(kArity, items.size() - begin)));
        }
        const auto child = static_cast<std::uint32_t>(first + below);
        add_node(first_node + n, std::span(children, here), child | SphereBvh::kLeafBit, above_leaves_[first_node + n]);
      }
    });
  }

  /// Sets a leaf.
  ///
  /// Result     padded bounds of its spheres
  Bounds add_leaf(std::size_t index, std::span<const SphereItem> items) {
    const kernel::RodArray& rods = spheres_.rods.rods;
    const BoxFrame& frame = spheres_.frame;
    bvh_.leaves[index] = make_leaf(items);
    Bounds bounds;
    float r[kArity], most = 0;
    for (std::size_t i = 0; i < items.size(); ++i) {
      const auto& [center, id] = items[i];
      if (bvh_.start_nodes.size() > 0)
        bvh_.start_nodes.set(rods.object(id), static_cast<std::uint32_t>(index / kArity));
      r[i] = own_radii_ ? rounded_up(spheres_.radius(id) * frame.scale) : bvh_.radius;
      most = std::max(most, r[i]);
      float reach[3] = {r[i], r[i], r[i]}, lower[3], upper[3];
      if (rods.contains(id)) {
        const RodExtent rod(spheres_.rods.at(rods.index(id), 0), frame);
        for (int axis = 0; axis < 3; ++axis) reach[axis] = rounded_up(std::abs(rod.half[axis]) + rod.radius);
      }
      if (id < spheres_.spheres.moving_count) {
        const RodExtent path(path_of(spheres_.spheres, id), frame);
        for (int axis = 0; axis < 3; ++axis) reach[axis] = rounded_up(std::abs(path.half[axis]) + path.radius);
      }
      for (int axis = 0; axis < 3; ++axis) {
        lower[axis] = center[axis] - (reach[axis] + box_padding_);
        upper[axis] = center[axis] + (reach[axis] + box_padding_);
      }
      bounds.add(lower, upper);
    }
    if (has_rods_ || bvh_.moves)
      bvh_.rods[index] = make_leaf_rods(bvh_.leaves[index], items.size(), spheres_.spheres, spheres_.rods, frame);
    if (!own_radii_) return bounds;
    bvh_.radii[index] = {{}, step_between(0, most)};
    for (std::size_t i = 0; i < items.size(); ++i)
      bvh_.radii[index].radius[i] = code_above(r[i], 0, bvh_.radii[index].step);
    return bounds;
  }

  void add_node(std::size_t index, std::span<const Bounds> children, std::uint32_t first, Bounds& all) {
    bvh_.nodes[index] = make_node(children, first);
    for (const Bounds& child : children) all.add(child);
  }

  /// Adds the nodes of the upper levels.
  void add_nodes(const SphereSort& sort) {
    std::vector<Bounds> below = std::move(above_leaves_);
    std::size_t level = 0, first = 0;
    while (true) {
      bvh_.cells.insert(bvh_.cells.end(), sort.cells(level).begin(), sort.cells(level).end());
      bvh_.level_begin[level++] = static_cast<std::uint32_t>(first);
      if (below.size() == 1) break;
      const std::size_t begin = bvh_.nodes.size();
      std::vector<Bounds> above(parents_of(below.size()));
      bvh_.nodes.resize(begin + above.size());
      tbb::parallel_for(Range(0, above.size(), 64), [&](const Range& range) {
        for (std::size_t n = range.begin(); n < range.end(); ++n) {
          const std::size_t child = n * kArity, count = std::min(kArity, below.size() - child);
          add_node(begin + n, std::span(&below[child], count), static_cast<std::uint32_t>(first + child), above[n]);
        }
      });
      first = begin;
      below = std::move(above);
    }
    std::copy_n(below[0].lower, 3, bvh_.box.lower);
    std::copy_n(below[0].upper, 3, bvh_.box.upper);
  }

  static std::size_t parents_of(std::size_t count) { return (count + kArity - 1) / kArity; }

  SphereBvh& bvh_;
  const EnclosingSpheres& spheres_;
  std::vector<std::uint32_t> ids_;
  base::HugeVector<SphereItem> items_;  ///< of the part that is being built
  std::vector<Bounds> above_leaves_;    ///< of the nodes above the leaves
  double mean_radius_ = 0;              ///< box space
  float reach_ = 0;  ///< largest distance of a surface from the centre of the enclosing sphere, box space
  float box_padding_ = 0;
  bool has_rods_ = false, own_radii_ = false;
};

}  // namespace

kernel::Sphere enclosing_sphere(const kernel::Rod& rod) noexcept {
  const double half[3] = {(rod.b[0] - rod.a[0]) / 2, (rod.b[1] - rod.a[1]) / 2, (rod.b[2] - rod.a[2]) / 2};
  return {rod.a[0] + half[0], rod.a[1] + half[1], rod.a[2] + half[2],
          std::hypot(half[0], half[1], half[2]) + rod.radius};
}

kernel::Rod path_of(const BoundedSpheres& spheres, std::size_t id) noexcept {
  const kernel::Sphere from = spheres[id], to = spheres.at(id, 1);
  kernel::Rod out{{from.x, from.y, from.z}, std::max(from.radius, to.radius), {to.x, to.y, to.z}, 0};
  // The kernel rounds the interpolated sphere, whose numbers are each the sum of two rounded ones.
  if (spheres.in_single) {
    const kernel::Sphere all = enclosing_sphere(out);
    out.radius += 0x1p-22 * (std::abs(all.x) + std::abs(all.y) + std::abs(all.z) + all.radius);
  }
  return out;
}

kernel::Sphere enclosing_sphere(const BoundedSpheres& spheres, std::size_t id) noexcept {
  return id >= spheres.moving_count ? spheres[id] : enclosing_sphere(path_of(spheres, id));
}

SphereBvh::SphereBvh(const BoundedSpheres& spheres, std::vector<std::uint32_t> ids, const BoxFrame& frame,
                     const std::function<bool(double)>& monitor, const BoundedRods& bounded_rods,
                     std::size_t size_of_parts)
    : count(ids.size()) {
  Builder(*this, {spheres, bounded_rods, frame}, std::move(ids))
      .run(monitor, size_of_parts > 0 ? size_of_parts : part_size(count));
}

std::uint64_t SphereBvh::bytes_of_build(const ObjectCounts& objects) noexcept {
  const std::uint64_t count = objects.all(), leaf_count = count / kArity + 1,
                      node_count = leaf_count / (kArity - 1) + 1;
  return leaf_count * (sizeof(Leaf) + (objects.have_one_radius ? 0 : sizeof(LeafRadii)) +
                       (objects.rods > 0 || objects.move ? sizeof(LeafRods) : 0)) +
         node_count * (sizeof(Node) + sizeof(Cell)) + (count > kMostStartNodes ? 0 : 3 * count) +
         std::min<std::uint64_t>(count, part_size(count)) * sizeof(SphereItem);
}

std::size_t SphereBvh::bytes() const noexcept {
  return start_nodes.bytes() + cells.size() * sizeof(Cell) + leaves.size() * sizeof(Leaf) +
         radii.size() * sizeof(LeafRadii) + rods.size() * sizeof(LeafRods) + nodes.size() * sizeof(Node);
}

}  // namespace orrery::accel
