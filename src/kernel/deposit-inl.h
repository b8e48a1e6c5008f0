// SPDX-License-Identifier: Apache-2.0
// Radiance of paths, from their vertices to the sums of their pixels.
#pragma once

#include <hwy/highway.h>

#include <algorithm>
#include <cstdint>
#include <utility>

#include "kernel/gather-inl.h"
#include "kernel/path_record.h"
#include "kernel/path_stream.h"
#include "kernel/pixel_sum.h"
#include "kernel/render_tile.h"
#include "kernel/scene_view.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

/// Adds radiance to paths of the batch.
///
/// `paths`    indices within the batch
template <class D>
HWY_INLINE void gain(D d, hn::Mask<D> lanes, const Vec3<hn::Vec<D>>& light, hn::Vec<IdTag<D>> paths,
                     BatchOf<hn::TFromD<D>>& batch) {
  HWY_ALIGN hn::TFromD<D> rgb[3][hn::MaxLanes(D())];
  HWY_ALIGN hn::TFromD<IdTag<D>> path[hn::MaxLanes(D())];
  hn::Store(light.x, d, rgb[0]);
  hn::Store(light.y, d, rgb[1]);
  hn::Store(light.z, d, rgb[2]);
  hn::Store(paths, IdTag<D>(), path);
  each_lane(d, lanes, [&](int i) {
    for (int k = 0; k < 3; ++k) batch.radiance[k][path[i]] += rgb[k][i];
  });
}

/// Converts numbers to units of 2^-60, like to_fixed_point().
///
/// Domain     |value| < 4
template <class D>
HWY_INLINE void store_fixed_point(D, hn::Vec<D> value, std::int64_t* to) {
  if constexpr (sizeof(hn::TFromD<D>) == 4 && hn::MaxLanes(D()) > 1) {
    const hn::Rebind<double, hn::Half<D>> wide;
    store_fixed_point(wide, hn::PromoteTo(wide, hn::LowerHalf(value)), to);
    store_fixed_point(wide, hn::PromoteTo(wide, hn::UpperHalf(hn::Half<D>(), value)), to + hn::Lanes(wide));
  } else {
    const hn::RebindToSigned<D> di;
    hn::Store(hn::ConvertTo(di, value * 0x1p60), di, to);
  }
}

/// The paths of a batch that belong to the same sum: consecutive samples of a pixel in a half.
template <class T>
class PathRun {
 public:
  HWY_INLINE PathRun(const BatchOf<T>& batch, const Tile& tile)
      : samples_(batch.sample), sample_end_(tile.sample_end), end_(end_of(0)) {}

  /// Whether the run ends before a path. If so, that path begins the next run.
  HWY_INLINE bool ends_before(int i) {
    if (i != end_) return false;
    end_ = end_of(i);
    return true;
  }

 private:
  /// The end of the run that begins with a path; beyond the batch if the run goes on in the next.
  HWY_INLINE int end_of(int i) const {
    const std::uint32_t left = (sample_end_ - static_cast<std::uint32_t>(samples_[i])) % Sampler::kSecondHalf;
    return i + static_cast<int>(std::min<std::uint32_t>(left, kStreamSize));
  }

  const IdOf<T>* samples_;
  std::uint32_t sample_end_;
  int end_;
};

/// Adds what the paths of a batch have gained to the sums of their pixels. Bad samples are counted and excluded.
template <class D, class T = hn::TFromD<D>>
HWY_INLINE void deposit(D d, const BatchOf<T>& batch, int count, const SceneView& scene, const Tile& tile,
                        TileCounts& counts) {
  PathRun<T> run(batch, tile);
  PixelSum sum;
  const auto add_sum = [&](int last) {
    tile.sums[tile.index(place_of(batch.pixel[last], scene), batch.sample[last])] += sum;
  };
  constexpr bool kConvertsVectors = HWY_TARGET <= HWY_AVX3;  // others have no instruction for it
  HWY_ALIGN std::int64_t units[3][hn::MaxLanes(D())];
  for (int v = 0; v < count; v += static_cast<int>(hn::Lanes(d))) {
    // Convert the common case as vectors. Compared one by one, since the maximum of a NaN and a number may be the
    // number.
    const auto light = load3(d, batch.radiance, v);
    const auto is_small = [&](hn::Vec<D> value) { return hn::Abs(value) < 4; };
    const bool are_small = hn::AllTrue(d, hn::And(hn::And(is_small(light.x), is_small(light.y)), is_small(light.z)));
    if (kConvertsVectors && are_small) {
      store_fixed_point(d, light.x, units[0]);
      store_fixed_point(d, light.y, units[1]);
      store_fixed_point(d, light.z, units[2]);
    }
    for (int lane = 0; lane < static_cast<int>(hn::Lanes(d)) && v + lane < count; ++lane) {
      const int i = v + lane;
      if (run.ends_before(i)) {
        add_sum(i - 1);
        sum = {};
      }
      if (are_small) {
        for (int k = 0; k < 3; ++k)
          sum.rgb[k] += kConvertsVectors
                            ? units[k][lane]
                            : static_cast<std::int64_t>(static_cast<double>(batch.radiance[k][i]) * 0x1p60);
        continue;
      }
      const auto r = static_cast<double>(batch.radiance[0][i]), g = static_cast<double>(batch.radiance[1][i]),
                 b = static_cast<double>(batch.radiance[2][i]);
      if (is_valid_sample(r, g, b)) {
        sum.rgb[0] += to_fixed_point(r);
        sum.rgb[1] += to_fixed_point(g);
        sum.rgb[2] += to_fixed_point(b);
      } else {
        --sum.weight;
        ++counts.bad_samples;
      }
    }
  }
  add_sum(count - 1);
}

/// Adds the coverage of a batch's paths to the sums of their pixels. On a transparent page, what paths lack of their
/// share of the radiance of the backdrop becomes coverage, in black: brighter paths count below 0, so that noise is no
/// shadow.
template <class T>
HWY_INLINE void add_coverage(BatchOf<T>& batch, int count, const SceneView& scene, const Tile& tile) {
  const math::Vec3d& backdrop = scene.backdrop;
  constexpr T kBrightest = 16;  // of a path, in radiances of the backdrop
  const auto whole = static_cast<T>(scene.has_backdrop ? backdrop.x + backdrop.y + backdrop.z : 3);
  for (int i = 0; i < count; ++i) {
    T coverage = batch.coverage[i];
    if (coverage < 0) {
      const T share = -std::exchange(coverage, T{0});
      if (!scene.background_visible && whole > 0) {
        const T seen = batch.radiance[0][i] + batch.radiance[1][i] + batch.radiance[2][i];
        coverage = share - std::min(std::max(T{0}, seen / whole), kBrightest);
        for (auto& channel : batch.radiance) channel[i] = 0;
      }
    }
    tile.covered[tile.index(place_of(batch.pixel[i], scene))] +=
        static_cast<std::int64_t>(static_cast<double>(coverage) / kGuideUnit);
  }
}

/// Raises the largest samples of pixels. Bad samples do not count. Not inlined.
template <class T>
HWY_NOINLINE void raise_largest(const BatchOf<T>& batch, int count, const SceneView& scene, const Tile& tile) {
  PathRun<T> run(batch, tile);
  T most = 0;
  const auto raise = [&](int last) {
    float& largest = tile.largest[tile.index(place_of(batch.pixel[last], scene))];
    largest = std::max(largest, static_cast<float>(most));
  };
  for (int i = 0; i < count; ++i) {
    if (run.ends_before(i)) {
      raise(i - 1);
      most = 0;
    }
    const T r = batch.radiance[0][i], g = batch.radiance[1][i], b = batch.radiance[2][i];
    if (is_valid_sample(static_cast<double>(r), static_cast<double>(g), static_cast<double>(b)))
      most = std::max(most, r + g + b);
  }
  raise(count - 1);
}

/// Stores what the paths of a batch have gained in their records.
template <class T>
HWY_INLINE void record_light(const BatchOf<T>& batch, int count, const SceneView& scene, const Tile& tile) {
  if (tile.records == nullptr || !tile.record_light) return;
  for (int i = 0; i < count; ++i) {
    PathRecord& record = tile.records[tile.record_index(place_of(batch.pixel[i], scene), batch.sample[i])];
    for (int k = 0; k < 3; ++k) record.light[k] = static_cast<double>(batch.radiance[k][i]);
  }
}

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
