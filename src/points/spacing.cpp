// SPDX-License-Identifier: Apache-2.0
#include "points/spacing.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <utility>
#include <vector>

#include "math/scalar.h"
#include "math/vec3.h"

namespace orrery::points {
namespace {

using math::Vec3d;

/// Up to this number, all points are in the sample.
constexpr std::size_t kMaxExact = 100'000;
/// Sample size of larger sets. The quantile of the median of n values has a standard deviation of 0.5 / sqrt(n).
constexpr std::size_t kSamples = 4'096;
/// Samples whose distances give the first bounds.
constexpr std::size_t kLeafSize = 8;
/// Scaled coordinates below this are 0, so that no square of a difference underflows.
constexpr double kTiny = 1e-130;
/// Cell indices beyond this do not occur at a sample: its nearest neighbour is at least one ulp away.
constexpr double kMaxCell = 0x1p53;

std::uint64_t mixed(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
  return x ^ (x >> 31);
}

/// Scales points by a power of 2, so that their coordinates are in [-2, 2].
struct Scale {
  double factor;

  Vec3d operator()(const Vec3d& p) const { return {of(p.x), of(p.y), of(p.z)}; }
  double of(double x) const { return std::abs(x * factor) < kTiny ? 0 : x * factor; }
};

/// A position in the sample, and the best known distance to its nearest neighbour.
struct Sample {
  Vec3d place;
  std::size_t count = 1;              ///< number of points of the sample at this position
  double nearest2 = math::kInfinity;  ///< squared distance

  void update(const Vec3d& p) {
    const Vec3d d = place - p;
    const double distance2 = dot(d, d);
    if (distance2 > 0 && distance2 < nearest2) nearest2 = distance2;
  }
};

/// Returns the sample: one point of each stratum of consecutive points, chosen by a hash. A constant stride could
/// choose one face of a lattice. Coincident points become one sample, because there may be millions.
std::vector<Sample> sample_of(const scene::PointArray& centers, const Scale& scale) {
  const std::size_t count = centers.size() <= kMaxExact ? centers.size() : kSamples;
  std::vector<Vec3d> places(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t begin = centers.size() * i / count, end = centers.size() * (i + 1) / count;
    places[i] = scale(centers[begin + mixed(i) % (end - begin)]);
  }
  std::sort(places.begin(), places.end(),
            [](const Vec3d& a, const Vec3d& b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); });
  std::vector<Sample> out;
  for (const Vec3d& place : places) {
    if (!out.empty() && out.back().place == place) {
      ++out.back().count;
    } else {
      out.push_back({place});
    }
  }
  return out;
}

/// Finds first bounds: splits the samples at the median of the longest axis, down to groups of a few neighbours.
void bound(Sample* begin, Sample* end) {
  if (static_cast<std::size_t>(end - begin) <= kLeafSize) {
    for (Sample* a = begin; a < end; ++a)
      for (const Sample* b = begin; b < end; ++b) a->update(b->place);
    return;
  }
  Vec3d low = begin->place, high = low;
  for (const Sample* s = begin; s < end; ++s) {
    low = math::least(low, s->place);
    high = math::greatest(high, s->place);
  }
  const Vec3d extent = high - low;
  const double Vec3d::*axis = extent.x >= extent.y && extent.x >= extent.z ? &Vec3d::x
                              : extent.y >= extent.z                       ? &Vec3d::y
                                                                           : &Vec3d::z;
  Sample* middle = begin + (end - begin) / 2;
  std::nth_element(begin, middle, end,
                   [axis](const Sample& a, const Sample& b) { return a.place.*axis < b.place.*axis; });
  bound(begin, middle);
  bound(middle, end);
}

/// Hash table from cells of space to the samples whose nearest neighbour may be in the cell. Each sample is in cells a
/// few times as large as the distance to its nearest neighbour so far, so that a single outlier or dense cluster does
/// not determine the size of all cells.
class SampleGrid {
 public:
  /// `octaves`  cell sizes differ by factors of 2^octaves. More octaves cost more distances to compute, fewer more
  ///            look-ups.
  SampleGrid(std::vector<Sample>& samples, int octaves) : samples_(samples), begin_(kBuckets + 1) {
    std::vector<std::pair<Entry, std::size_t>> entries;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const double radius = std::sqrt(samples[i].nearest2) * (1 + 1e-9);  // exceeds the rounding of cell_of()
      const int finest = std::ilogb(radius) + 2;
      const int exponent = finest + (octaves - 1) - (finest + (octaves - 1) + 3000) % octaves;
      const Level level{std::ldexp(1.0, -exponent), mixed(static_cast<std::uint64_t>(exponent))};
      if (std::find(levels_.begin(), levels_.end(), level) == levels_.end()) levels_.push_back(level);
      const Vec3d reach{radius, radius, radius};
      const Cell low = cell_of(samples[i].place - reach, level), high = cell_of(samples[i].place + reach, level);
      for (std::int64_t x = low.x; x <= high.x; ++x)
        for (std::int64_t y = low.y; y <= high.y; ++y)
          for (std::int64_t z = low.z; z <= high.z; ++z) {
            const std::uint64_t hash = hash_of({x, y, z}, level);
            entries.push_back({{hash, static_cast<std::uint32_t>(i)}, bucket_of(hash)});
            ++begin_[bucket_of(hash) + 1];
          }
    }
    for (std::size_t b = 0; b < kBuckets; ++b) begin_[b + 1] += begin_[b];
    entries_.resize(entries.size());
    std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
    for (const auto& [entry, bucket] : entries) entries_[next[bucket]++] = entry;
  }

  /// Updates the samples by a point.
  void add(const Vec3d& p) {
    for (const Level& level : levels_) {
      if (std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) * level.per_length >= kMaxCell) continue;
      const std::uint64_t hash = hash_of(cell_of(p, level), level);
      const std::size_t bucket = bucket_of(hash);
      for (std::uint32_t e = begin_[bucket]; e < begin_[bucket + 1]; ++e)
        if (entries_[e].hash == hash) samples_[entries_[e].sample].update(p);
    }
  }

 private:
  static constexpr int kBucketBits = 16;
  static constexpr std::size_t kBuckets = std::size_t{1} << kBucketBits;

  struct Level {
    double per_length;  ///< cells per unit of length, a power of 2
    std::uint64_t hash;

    bool operator==(const Level&) const = default;
  };
  struct Cell {
    std::int64_t x, y, z;
  };
  struct Entry {
    std::uint64_t hash;
    std::uint32_t sample;
  };

  static std::int64_t floor_of(double x) {
    const auto i = static_cast<std::int64_t>(x);  // std::floor is a function call on the baseline instruction set
    return i - (static_cast<double>(i) > x ? 1 : 0);
  }
  static Cell cell_of(const Vec3d& p, const Level& level) {
    return {floor_of(p.x * level.per_length), floor_of(p.y * level.per_length), floor_of(p.z * level.per_length)};
  }
  static std::uint64_t hash_of(const Cell& cell, const Level& level) {
    std::uint64_t h = level.hash;
    h = (h ^ static_cast<std::uint64_t>(cell.x)) * 0x9E3779B97F4A7C15u;
    h = (h ^ h >> 32 ^ static_cast<std::uint64_t>(cell.y)) * 0xD6E8FEB86659FD93u;
    h = (h ^ h >> 32 ^ static_cast<std::uint64_t>(cell.z)) * 0x9E3779B97F4A7C15u;
    return h;
  }
  static std::size_t bucket_of(std::uint64_t hash) { return hash >> (64 - kBucketBits); }

  std::vector<Sample>& samples_;
  std::vector<Level> levels_;
  std::vector<std::uint32_t> begin_;  ///< first entry of each bucket in entries_
  std::vector<Entry> entries_;
};

/// The median of the distances, each as often as its sample counts.
double median(std::vector<Sample>& samples) {
  std::sort(samples.begin(), samples.end(), [](const Sample& a, const Sample& b) { return a.nearest2 < b.nearest2; });
  std::size_t total = 0, below = 0;
  for (const Sample& sample : samples) total += sample.count;
  for (const Sample& sample : samples) {
    below += sample.count;
    if (2 * below >= total) return std::sqrt(sample.nearest2);
  }
  return 0;
}

}  // namespace

double median_neighbor_distance(const scene::PointArray& centers) {
  double largest = 0;
  for (const Vec3d p : centers) largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  if (largest == 0) return 0;
  const Scale scale{std::ldexp(1.0, -std::clamp(std::ilogb(largest), -1000, 1000))};

  std::vector<Sample> samples = sample_of(centers, scale);
  if (samples.size() == 1) {
    for (const Vec3d p : centers) samples[0].update(scale(p));
    return samples[0].nearest2 < math::kInfinity ? std::sqrt(samples[0].nearest2) / scale.factor : 0;
  }
  bound(samples.data(), samples.data() + samples.size());
  // The sample is a small fraction of the positions, so that a large cell contains few of its points.
  const auto singles =
      std::count_if(samples.begin(), samples.end(), [](const Sample& sample) { return sample.count == 1; });
  const bool is_sparse = centers.size() > kMaxExact && static_cast<std::size_t>(singles) > samples.size() / 10 * 9;
  // A few points first: they reduce the cell size for the others.
  for (const std::size_t stride : {1024, 64, 8, 1}) {
    SampleGrid grid(samples, is_sparse ? 3 : 1);
    for (std::size_t i = 0; i < centers.size(); i += stride) grid.add(scale(centers[i]));
  }
  return median(samples) / scale.factor;
}

}  // namespace orrery::points
