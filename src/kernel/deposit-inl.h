// SPDX-License-Identifier: Apache-2.0
// Adds the radiance of paths to their pixels. Compiled once per instruction set.
#if defined(ORRERY_KERNEL_DEPOSIT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ORRERY_KERNEL_DEPOSIT_INL_H_
#undef ORRERY_KERNEL_DEPOSIT_INL_H_
#else
#define ORRERY_KERNEL_DEPOSIT_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>

#include "kernel/compaction-inl.h"
#include "kernel/path_stream.h"
#include "kernel/record-inl.h"
#include "kernel/render_tile.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

/// The index of a pixel of the tile among its sums.
HWY_INLINE std::int64_t index_of(std::uint64_t pixel, const SceneView& scene, const Tile& tile) {
  const PixelPlace at = place_of(pixel, scene);
  return (at.y - tile.y) * tile.row_stride + (at.x - tile.x);
}
HWY_INLINE PixelSum& sum_of(std::uint64_t pixel, const SceneView& scene, const Tile& tile) {
  return tile.sums[index_of(pixel, scene, tile)];
}

/// Raises the largest samples of the pixels of finished paths. Bad samples do not count.
template <class D>
HWY_INLINE void raise_largest(D d, hn::Mask<D> lanes, const Vec3<hn::Vec<D>>& light, const hn::TFromD<IdTag<D>>* pixel,
                              const SceneView& scene, const Tile& tile) {
  const auto is_valid = [&](hn::Vec<D> v) { return hn::Abs(v) <= set(d, kLargestSample); };
  const auto valid = hn::And(hn::And(is_valid(light.x), is_valid(light.y)), is_valid(light.z));
  HWY_ALIGN hn::TFromD<D> value[hn::MaxLanes(D())];
  hn::Store(light.x + light.y + light.z, d, value);
  each_lane(d, hn::And(lanes, valid), [&](int i) {
    float& largest = tile.largest[index_of(pixel[i], scene, tile)];
    largest = std::max(largest, static_cast<float>(value[i]));
  });
}

/// Converts to units of 2^-60, like to_fixed_point().
///
/// Domain     |value| < 4
HWY_INLINE void store_fixed_point(hn::ScalableTag<double> d, hn::Vec<hn::ScalableTag<double>> value, std::int64_t* to) {
  const hn::RebindToSigned<decltype(d)> di;
  hn::Store(hn::ConvertTo(di, value * 0x1p60), di, to);
}
HWY_INLINE void store_fixed_point(hn::ScalableTag<float> d, hn::Vec<hn::ScalableTag<float>> value, std::int64_t* to) {
  const hn::ScalableTag<double> wide;
  const hn::Half<decltype(d)> half;
  store_fixed_point(wide, hn::PromoteTo(wide, hn::LowerHalf(half, value)), to);
  store_fixed_point(wide, hn::PromoteTo(wide, hn::UpperHalf(half, value)), to + hn::Lanes(wide));
}

/// Adds finished paths to their pixels. Bad samples are counted and excluded from the sums.
template <class D>
HWY_INLINE void deposit(D d, hn::Mask<D> lanes, const Vec3<hn::Vec<D>>& light, hn::Vec<IdTag<D>> pixels,
                        hn::Vec<IdTag<D>> samples, const SceneView& scene, const Tile& tile, TileCounts& counts) {
  using T = hn::TFromD<D>;
  HWY_ALIGN hn::TFromD<IdTag<D>> pixel[hn::MaxLanes(D())];
  hn::Store(pixels, IdTag<D>(), pixel);
  if (tile.largest != nullptr) raise_largest(d, lanes, light, pixel, scene, tile);
  // Other instruction sets convert lanes one by one.
  if constexpr (HWY_TARGET <= HWY_AVX3 && hn::MaxLanes(D()) > 1) {
    // Compared one by one, since the maximum of a NaN and a number may be the number.
    const auto converts = [&](hn::Vec<D> v) { return hn::Abs(v) < 4; };
    const auto all_convert = hn::And(hn::And(converts(light.x), converts(light.y)), converts(light.z));
    if (scene.filter.negative_share == 0 && hn::AllFalse(d, hn::AndNot(all_convert, lanes))) {
      HWY_ALIGN std::int64_t rgb[3][hn::MaxLanes(D())];
      store_fixed_point(d, light.x, rgb[0]);
      store_fixed_point(d, light.y, rgb[1]);
      store_fixed_point(d, light.z, rgb[2]);
      const auto is_black = max(max(hn::Abs(light.x), hn::Abs(light.y)), hn::Abs(light.z)) == 0;
      each_lane(d, hn::AndNot(is_black, lanes), [&](int i) {
        PixelSum& sum = sum_of(pixel[i], scene, tile);
        for (int k = 0; k < 3; ++k) sum.rgb[k] += rgb[k][i];
      });
      return;
    }
  }
  HWY_ALIGN T rgb[3][hn::MaxLanes(D())];
  HWY_ALIGN hn::TFromD<IdTag<D>> sample[hn::MaxLanes(D())];
  hn::Store(light.x, d, rgb[0]);
  hn::Store(light.y, d, rgb[1]);
  hn::Store(light.z, d, rgb[2]);
  hn::Store(samples, IdTag<D>(), sample);
  each_lane(d, lanes, [&](int i) {
    if (rgb[0][i] == T(0) && rgb[1][i] == T(0) && rgb[2][i] == T(0)) return;
    PixelSum& sum = sum_of(pixel[i], scene, tile);
    const auto r = static_cast<double>(rgb[0][i]), g = static_cast<double>(rgb[1][i]),
               b = static_cast<double>(rgb[2][i]);
    const bool negative = scene.filter.negative_share != 0 && scene.filter.weight(sample[i], sample[i] + 1) < 0;
    if (!is_valid_sample(r, g, b)) {
      sum.weight -= negative ? -1 : 1;
      ++counts.bad_samples;
    } else if (negative) {
      sum.rgb[0] -= to_fixed_point(r);
      sum.rgb[1] -= to_fixed_point(g);
      sum.rgb[2] -= to_fixed_point(b);
    } else {
      sum.rgb[0] += to_fixed_point(r);
      sum.rgb[1] += to_fixed_point(g);
      sum.rgb[2] += to_fixed_point(b);
    }
  });
}

/// Starts the paths first .. first + kPacketSize of a batch whose radiance is summed in `lit`.
template <class D, class Carried, class Lit>
HWY_INLINE void begin_paths(D d, int first, Carried& carried, Lit& lit) {
  using Id = hn::TFromD<IdTag<D>>;
  const IdTag<D> du;
  for (int v = 0; v < kPacketSize; v += static_cast<int>(hn::Lanes(d))) {
    const int i = first + v;
    hn::Store(hn::Iota(du, static_cast<Id>(i)), du, carried.path + v);
    hn::Store(hn::Load(du, carried.pixel + v), du, lit.pixel + i);
    hn::Store(hn::Load(du, carried.sample + v), du, lit.sample + i);
    for (auto& channel : lit.radiance) hn::Store(hn::Zero(d), d, channel + i);
  }
}

/// Adds radiance to paths of the batch.
template <class D, class Lit>
HWY_INLINE void gain(D d, hn::Mask<D> lanes, const Vec3<hn::Vec<D>>& light, hn::Vec<IdTag<D>> paths, Lit& lit) {
  using T = hn::TFromD<D>;
  HWY_ALIGN T rgb[3][hn::MaxLanes(D())];
  HWY_ALIGN hn::TFromD<IdTag<D>> path[hn::MaxLanes(D())];
  hn::Store(light.x, d, rgb[0]);
  hn::Store(light.y, d, rgb[1]);
  hn::Store(light.z, d, rgb[2]);
  hn::Store(paths, IdTag<D>(), path);
  each_lane(d, lanes, [&](int i) {
    for (int k = 0; k < 3; ++k) lit.radiance[k][path[i]] += rgb[k][i];
  });
}

/// Deposits the radiance of the batch's paths.
template <class D, class Lit>
HWY_INLINE void deposit_paths(D d, int count, const SceneView& scene, const Tile& tile, const Lit& lit,
                              TileCounts& counts) {
  const IdTag<D> du;
  for (int i = 0; i < count; i += static_cast<int>(hn::Lanes(d))) {
    const auto active = hn::FirstN(d, static_cast<std::size_t>(count - i));
    const auto light = load3(d, lit.radiance, i);
    const auto pixels = hn::Load(du, lit.pixel + i), samples = hn::Load(du, lit.sample + i);
    deposit(d, active, light, pixels, samples, scene, tile, counts);
    Recorder<D>(scene, tile, pixels, samples).light(d, active, light);
  }
}

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
