// SPDX-License-Identifier: Apache-2.0
#include "points/bonds.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <utility>

#include "base/stop_point.h"

namespace orrery::points {
namespace {

using data::Vec3d;

/// Boxes whose volume is a smaller fraction of that of a cuboid with the same edges are flat.
constexpr double kSmallestVolume = 1e-9;
/// Farther images are clamped to this, so that shifts and their sums fit into 32 bits.
constexpr double kFarthestImage = 5e8;
/// Points per task. The result does not depend on it.
constexpr std::size_t kGrain = 1 << 14;

double component(Vec3d v, std::size_t axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

/// The cells of one axis: numbers from 0, such that points in reach are in the same cell or in `span` cells beside it.
class CellAxis {
 public:
  static constexpr int kBits = 21;  ///< of a cell's number: three fit into a key

  /// `width`    length of the fraction 1
  CellAxis(bool is_periodic, double width, double reach) : is_periodic_(is_periodic), per_fraction_(width / reach) {
    if (!is_periodic) return;
    // Cells are a little larger than the reach, so that rounding of a cell's number does not matter.
    count_ = static_cast<std::int64_t>(std::clamp(std::floor(per_fraction_ * (1 - kMargin)), 1.0, kMaxCells));
    span_ = static_cast<int>(std::min(std::ceil(static_cast<double>(count_) / per_fraction_), kMaxSpan));
    per_fraction_ = static_cast<double>(count_);
  }

  /// Sets the cells of an axis that is not periodic.
  ///
  /// `fraction_of`   f(i) of point i
  template <class F>
  void fit(std::size_t points, F fraction_of) {
    if (is_periodic_) return;
    per_fraction_ *= 1 - kMargin;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (std::size_t i = 0; i < points; ++i) {
      low = std::min(low, fraction_of(i));
      high = std::max(high, fraction_of(i));
    }
    first_ = low;
    if ((high - low) * per_fraction_ < kMaxCells - 1) {
      count_ = slab(high) + 1;
      return;
    }
    // Single points are far away, as after the explosion of a simulation. Empty cells between points are left out,
    // except for one.
    first_ = 0;  // differences from a far point would be rounded
    slabs_.resize(points);
    for (std::size_t i = 0; i < points; ++i) slabs_[i] = slab(fraction_of(i));
    tbb::parallel_sort(slabs_.begin(), slabs_.end());
    slabs_.erase(std::unique(slabs_.begin(), slabs_.end()), slabs_.end());
    numbers_.reserve(slabs_.size());
    for (std::size_t i = 0; i < slabs_.size(); ++i)
      numbers_.push_back(i == 0 ? 0 : numbers_.back() + (slabs_[i] - slabs_[i - 1] == 1 ? 1 : 2));
    count_ = numbers_.back() + 1;
    for (; static_cast<double>(count_) > kMaxCells; ++coarsening_) count_ = (count_ + 1) / 2;
  }

  bool is_periodic() const { return is_periodic_; }
  std::int64_t count() const { return count_; }
  /// Cells to search on both sides.
  int span() const { return span_; }
  /// False if a point reaches more images of itself than can be bonded to it.
  bool is_searchable() const { return span_ < static_cast<int>(kMaxSpan); }

  /// `fraction`   of a periodic axis: in [0, 1), up to rounding
  std::int64_t cell(double fraction) const {
    if (is_periodic_)
      return std::clamp<std::int64_t>(static_cast<std::int64_t>(fraction * per_fraction_), 0, count_ - 1);
    const std::int64_t at = slab(fraction);
    if (slabs_.empty()) return std::clamp<std::int64_t>(at, 0, count_ - 1);
    const auto found = std::lower_bound(slabs_.begin(), slabs_.end() - 1, at) - slabs_.begin();
    return numbers_[static_cast<std::size_t>(found)] >> coarsening_;
  }

 private:
  static constexpr double kMaxCells = 1 << kBits, kMaxSpan = 40, kMargin = 1e-9;

  std::int64_t slab(double fraction) const {
    constexpr double kLast = 0x1p62;
    return static_cast<std::int64_t>(std::floor(std::clamp((fraction - first_) * per_fraction_, -kLast, kLast)));
  }

  bool is_periodic_;
  double per_fraction_;  ///< cells
  double first_ = 0;
  std::int64_t count_ = 1;
  int span_ = 1;
  std::vector<std::int64_t> slabs_, numbers_;  ///< occupied slabs and their cells, if slabs are left out
  int coarsening_ = 0;
};

class Search {
 public:
  Search(const scene::PointArray& points, const Reach& reach, const Lattice& lattice, double largest)
      : points_(points),
        reach_(reach),
        lattice_(lattice),
        axes_{CellAxis{lattice.is_periodic(0), lattice.width(0), largest},
              CellAxis{lattice.is_periodic(1), lattice.width(1), largest},
              CellAxis{lattice.is_periodic(2), lattice.width(2), largest}} {}

  std::optional<BondSet> run() {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!axes_[axis].is_searchable()) return {};
      axes_[axis].fit(points_.size(), [&](std::size_t i) { return component(lattice_.fractional(points_[i]), axis); });
    }
    sort_into_cells();
    constexpr std::size_t kCellsPerTask = 256;
    const std::size_t tasks = (keys_.size() + kCellsPerTask - 1) / kCellsPerTask;
    std::vector<BondSet> found(tasks);
    tbb::parallel_for(std::size_t{0}, tasks, [&](std::size_t task) {
      stop_.check();
      const std::size_t end = std::min(keys_.size(), (task + 1) * kCellsPerTask);
      for (std::size_t cell = task * kCellsPerTask; cell < end && !has_too_many_; ++cell) search(cell, found[task]);
    });
    if (has_too_many_) return {};
    BondSet out;
    std::size_t pairs = 0;
    for (const BondSet& part : found) pairs += part.pairs.size();
    out.pairs.reserve(pairs);
    for (BondSet& part : found) {
      out.pairs.insert(out.pairs.end(), part.pairs.begin(), part.pairs.end());
      out.crossing.insert(out.crossing.end(), part.crossing.begin(), part.crossing.end());
      part = {};
    }
    tbb::parallel_sort(out.pairs.begin(), out.pairs.end());
    tbb::parallel_sort(out.crossing.begin(), out.crossing.end());
    return out;
  }

 private:
  /// A point, moved into the box.
  struct Item {
    Vec3d place;
    std::uint32_t index = 0, label = 0;
  };
  /// The points of a cell in another image of the box.
  struct Neighbor {
    std::size_t cell = 0;
    Shift shift = {0, 0, 0};
    Vec3d translation{0, 0, 0};
  };

  static std::uint64_t key_of(const std::array<std::int64_t, 3>& cell) {
    return (static_cast<std::uint64_t>(cell[2]) << CellAxis::kBits | static_cast<std::uint64_t>(cell[1]))
               << CellAxis::kBits |
           static_cast<std::uint64_t>(cell[0]);
  }
  static std::array<std::int64_t, 3> cell_of(std::uint64_t key) {
    constexpr std::uint64_t kMask = (std::uint64_t{1} << CellAxis::kBits) - 1;
    return {static_cast<std::int64_t>(key & kMask), static_cast<std::int64_t>(key >> CellAxis::kBits & kMask),
            static_cast<std::int64_t>(key >> 2 * CellAxis::kBits)};
  }

  /// A point, moved into the box along the periodic axes.
  Vec3d wrapped(std::size_t i) const {
    const Vec3d p = points_[i];
    return lattice_.is_periodic() ? p - lattice_.translation(lattice_.image_of(p)) : p;
  }

  void sort_into_cells() {
    using Keyed = std::pair<std::uint64_t, std::uint32_t>;
    std::vector<Keyed> order(points_.size());
    each([&](std::size_t i) {
      const Vec3d fraction = lattice_.fractional(wrapped(i));
      const std::array<std::int64_t, 3> cell = {axes_[0].cell(fraction.x), axes_[1].cell(fraction.y),
                                                axes_[2].cell(fraction.z)};
      order[i] = {key_of(cell), static_cast<std::uint32_t>(i)};
    });
    tbb::parallel_sort(order.begin(), order.end());
    items_.resize(order.size());
    each([&](std::size_t i) {
      const std::uint32_t index = order[i].second;
      items_[i] = {wrapped(index), index, reach_.labels.empty() ? 0 : reach_.labels[index]};
    });
    for (std::size_t i = 0; i < order.size(); ++i) {
      if (i > 0 && order[i].first == order[i - 1].first) continue;
      keys_.push_back(order[i].first);
      begins_.push_back(i);
    }
    begins_.push_back(order.size());
  }

  template <class F>
  void each(F f) const {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, points_.size(), kGrain), [&](const auto& range) {
      stop_.check();
      for (std::size_t i = range.begin(); i < range.end(); ++i) f(i);
    });
  }

  /// Finds the occupied cells around a cell, and in which image of the box each is.
  void neighbors_of(std::size_t cell, std::vector<Neighbor>& out) const {
    out.clear();
    const std::array<std::int64_t, 3> center = cell_of(keys_[cell]);
    std::array<std::int64_t, 3> at{};
    Shift shift{};
    // Sets one coordinate; false outside the grid.
    const auto set = [&](std::size_t axis, int step) {
      const std::int64_t count = axes_[axis].count();
      at[axis] = center[axis] + step;
      shift[axis] = 0;
      if (!axes_[axis].is_periodic()) return at[axis] >= 0 && at[axis] < count;
      const std::int64_t image = (at[axis] >= 0 ? at[axis] : at[axis] - count + 1) / count;
      shift[axis] = static_cast<std::int32_t>(image);
      at[axis] -= image * count;
      return true;
    };
    const auto [span_x, span_y, span_z] = std::array{axes_[0].span(), axes_[1].span(), axes_[2].span()};
    for (int z = -span_z; z <= span_z; ++z) {
      if (!set(2, z)) continue;
      for (int y = -span_y; y <= span_y; ++y) {
        if (!set(1, y)) continue;
        // Cells along x follow each other.
        std::size_t found = keys_.size();
        std::uint64_t last = 0;
        for (int x = -span_x; x <= span_x; ++x) {
          if (!set(0, x)) continue;
          const std::uint64_t key = key_of(at);
          if (found < keys_.size() && key == last + 1)
            found += keys_[found] < key ? 1 : 0;
          else
            found = static_cast<std::size_t>(std::lower_bound(keys_.begin(), keys_.end(), key) - keys_.begin());
          last = key;
          if (found < keys_.size() && keys_[found] == key) out.push_back({found, shift, lattice_.translation(shift)});
        }
      }
    }
  }

  void search(std::size_t cell, BondSet& out) {
    thread_local std::vector<Neighbor> neighbors;
    neighbors_of(cell, neighbors);
    for (std::size_t i = begins_[cell]; i < begins_[cell + 1]; ++i) {
      const Item& a = items_[i];
      std::size_t count = 0;
      for (const Neighbor& neighbor : neighbors) {
        const Vec3d place = a.place - neighbor.translation;
        for (std::size_t j = begins_[neighbor.cell]; j < begins_[neighbor.cell + 1]; ++j) {
          const Item& b = items_[j];
          const Vec3d d = b.place - place;
          const double distance2 = math::dot(d, d);
          const double longest = reach_.of_label[a.label] + reach_.of_label[b.label];
          const double shortest = longest * reach_.smallest;
          if (!(distance2 < longest * longest) || distance2 < shortest * shortest) continue;
          if (i == j && neighbor.shift == Shift{0, 0, 0}) continue;
          if (++count > kMaxNeighbors) {
            has_too_many_ = true;
            return;
          }
          add(a.index, b.index, neighbor.shift, out);
        }
      }
    }
  }

  /// Adds a bond to the image of b's wrapped place, unless it is also found from b.
  void add(std::uint32_t a, std::uint32_t b, Shift shift, BondSet& out) const {
    if (a > b) return;
    if (lattice_.is_periodic()) {
      const Shift of_a = lattice_.image_of(points_[a]), of_b = lattice_.image_of(points_[b]);
      for (std::size_t axis = 0; axis < 3; ++axis) shift[axis] += of_a[axis] - of_b[axis];
    }
    if (shift == Shift{0, 0, 0})
      out.pairs.push_back({a, b});
    else if (a < b || shift > Shift{0, 0, 0})
      out.crossing.push_back({a, b, shift});
  }

  const scene::PointArray& points_;
  const Reach& reach_;
  const Lattice& lattice_;
  base::StopPoint stop_;
  std::array<CellAxis, 3> axes_;
  std::vector<Item> items_;          ///< by cell
  std::vector<std::uint64_t> keys_;  ///< of the occupied cells, ascending
  std::vector<std::size_t> begins_;  ///< first item of each cell, and the end of the last
  std::atomic<bool> has_too_many_ = false;
};

}  // namespace

Lattice::Lattice(const std::optional<data::Box>& box) {
  box_.periodic = {false, false, false};
  if (box) box_ = *box;
  set_free_edges();
  if (!set_reciprocal()) {
    box_ = data::Box();
    box_.periodic = {false, false, false};
    set_reciprocal();
  }
}

/// Makes the edges without images perpendicular to the others, and of length 1: they are only axes of coordinates.
void Lattice::set_free_edges() {
  auto& edges = box_.edges;
  const auto count = std::count(box_.periodic.begin(), box_.periodic.end(), true);
  if (count == 0) edges = data::Box().edges;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Vec3d& next = edges[(axis + 1) % 3];
    Vec3d& last = edges[(axis + 2) % 3];
    if (count == 1 && is_periodic(axis)) {
      const Vec3d e = edges[axis];
      const bool is_along_x = std::abs(e.x) > std::abs(e.y) && std::abs(e.x) > std::abs(e.z);
      next = math::normalized(math::cross(e, is_along_x ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0}));
      last = math::normalized(math::cross(e, next));
    } else if (count == 2 && !is_periodic(axis)) {
      edges[axis] = math::normalized(math::cross(next, last));
    }
  }
}

/// Returns false if the box has no volume.
bool Lattice::set_reciprocal() {
  const auto& [a, b, c] = box_.edges;
  const double volume = math::dot(a, math::cross(b, c));
  const double cuboid = math::length(a) * math::length(b) * math::length(c);
  reciprocal_ = {math::cross(b, c) / volume, math::cross(c, a) / volume, math::cross(a, b) / volume};
  return std::abs(volume) > kSmallestVolume * cuboid && math::is_finite(reciprocal_[0]) &&
         math::is_finite(reciprocal_[1]) && math::is_finite(reciprocal_[2]);
}

Vec3d Lattice::fractional(Vec3d p) const {
  const Vec3d d = p - box_.origin;
  return {math::dot(reciprocal_[0], d), math::dot(reciprocal_[1], d), math::dot(reciprocal_[2], d)};
}

Shift Lattice::image_of(Vec3d p) const {
  const Vec3d fraction = fractional(p);
  Shift out{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (is_periodic(axis))
      out[axis] =
          static_cast<std::int32_t>(std::clamp(std::floor(component(fraction, axis)), -kFarthestImage, kFarthestImage));
  return out;
}

Vec3d Lattice::translation(const Shift& shift) const {
  return box_.edges[0] * shift[0] + box_.edges[1] * shift[1] + box_.edges[2] * shift[2];
}

Shift Lattice::shift_to_nearest(Vec3d from, Vec3d to) const {
  if (!is_periodic()) return {0, 0, 0};
  const Vec3d d = to - from;
  const Vec3d fraction{math::dot(reciprocal_[0], d), math::dot(reciprocal_[1], d), math::dot(reciprocal_[2], d)};
  Shift rounded{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (is_periodic(axis))
      rounded[axis] = static_cast<std::int32_t>(
          -std::clamp(std::nearbyint(component(fraction, axis)), -kFarthestImage, kFarthestImage));
  // In a tilted box, an image beside it can be closer. Of equally close ones, no shift is preferred, then the smallest.
  const std::array<std::int32_t, 3> steps = {is_periodic(0), is_periodic(1), is_periodic(2)};
  Shift best = rounded;
  double best2 = std::numeric_limits<double>::infinity();
  const auto consider = [&](const Shift& shift) {
    const Vec3d moved = d + translation(shift);
    if (const double length2 = math::dot(moved, moved); length2 < best2) {
      best = shift;
      best2 = length2;
    }
  };
  consider({0, 0, 0});
  for (std::int32_t x = -steps[0]; x <= steps[0]; ++x)
    for (std::int32_t y = -steps[1]; y <= steps[1]; ++y)
      for (std::int32_t z = -steps[2]; z <= steps[2]; ++z) consider({rounded[0] + x, rounded[1] + y, rounded[2] + z});
  return best;
}

std::optional<BondSet> find_bonds(const scene::PointArray& points, const Reach& reach, const Lattice& lattice) {
  const double largest = 2 * *std::max_element(reach.of_label.begin(), reach.of_label.end());
  if (points.empty() || !(largest > 0)) return BondSet();
  return Search(points, reach, lattice, largest).run();
}

}  // namespace orrery::points
