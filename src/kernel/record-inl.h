// SPDX-License-Identifier: Apache-2.0
// Recording of paths, for layers other than the beauty.
#pragma once

#include <hwy/highway.h>

#include <algorithm>
#include <type_traits>

#include "kernel/gather-inl.h"
#include "kernel/path_record.h"
#include "kernel/pixel_sum.h"
#include "kernel/render_tile.h"
#include "kernel/scatter-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

// The bits of a path's `history`.
inline constexpr unsigned kLobeBits = 3;      ///< a FirstLobe, or 0 before the first surface
inline constexpr unsigned kOnlyDeltaBit = 4;  ///< only delta materials so far
inline constexpr unsigned kIndirectBit = 8;   ///< scattered again, not counting transmission through glass
inline constexpr unsigned kCoatBit = 16;      ///< shadow rays: a part of the light is scattered by a coat
enum FirstLobe : unsigned { kDiffuse = 1, kSpecular = 2, kTransmission = 3 };

/// Writes the records, events and guides of one vector of paths, as far as the tile has them.
template <class D>
class Recorder {
 public:
  using V = hn::Vec<D>;
  using Ids = hn::Vec<IdTag<D>>;
  using Id = hn::TFromD<IdTag<D>>;

  HWY_INLINE Recorder(const SceneView& scene, const Tile& tile, Ids pixels, Ids samples)
      : scene_(scene), tile_(tile), pixels_(pixels), samples_(samples) {}

  /// Records paths without a first hit.
  HWY_INLINE void no_hit(D d, hn::Mask<D> missed) {
    if (tile_.records == nullptr || !tile_.record_hits) return;
    each(d, missed, [](PathRecord& r, int) { r.object = kNone; });
  }

  /// Records the first hits.
  ///
  /// `times`    times of the rays; null if nothing moves
  HWY_INLINE void first_hit(D d, hn::Mask<D> hit, Ids objects, const Vec3<V>& offset, const Vec3<V>& direction,
                            const hn::TFromD<D>* times) {
    if (tile_.records == nullptr || !tile_.record_hits) return;
    const IdTag<D> du;
    HWY_ALIGN Id object[kMax];
    Stored at(d, offset), along(d, direction);
    hn::Store(objects, du, object);
    each(d, hit, [&](PathRecord& r, int i) {
      r.object = static_cast<std::uint32_t>(object[i]);
      if (times != nullptr) r.time = static_cast<double>(times[i]);
      r.offset = at.lane(i);
      r.direction = along.lane(i);
    });
  }

  /// Records the albedo at the first hits.
  HWY_INLINE void albedo(D d, hn::Mask<D> hit, const Vec3<V>& albedo) {
    if (tile_.records == nullptr || !tile_.record_hits) return;
    Stored color(d, albedo);
    each(d, hit, [&](PathRecord& r, int i) {
      for (int k = 0; k < 3; ++k) r.albedo[k] = static_cast<float>(color.v[k][i]);
    });
  }

  /// Writes light events for radiance that paths gained.
  ///
  /// `groups`   light groups of the sources
  /// `unscattered`  lobe of light that no surface has scattered
  HWY_INLINE void event(D d, hn::Mask<D> lanes, const Vec3<V>& light, Ids history, Ids groups, Lobe unscattered) {
    if (!tile_.has_events()) return;
    const IdTag<D> du;
    HWY_ALIGN Id way[kMax], group[kMax];
    Stored rgb(d, light);
    hn::Store(history, du, way);
    hn::Store(groups, du, group);
    const Names names(*this);
    LightEvents& events = *tile_.events;
    if (events.end - events.next < kPacketSize) events.make_room(events);
    each_lane(d, lanes, [&](int i) {
      const unsigned lobe = static_cast<unsigned>(way[i]) & kLobeBits;
      const bool direct = (static_cast<unsigned>(way[i]) & kIndirectBit) == 0;
      LightEvent& e = *events.next++;
      for (int k = 0; k < 3; ++k) e.value[k] = static_cast<double>(rgb.v[k][i]);
      e.path = static_cast<std::uint32_t>(index(names, i));
      e.group = static_cast<std::uint16_t>(group[i]);
      e.lobe = lobe != 0 ? static_cast<Lobe>(2 * lobe - (direct ? 1 : 0)) : unscattered;
    });
  }

  /// Adds the guides of the first surfaces that are not delta, or of the background, to the tile's sums.
  HWY_INLINE void guide(D d, hn::Mask<D> lanes, const Vec3<V>& albedo, const Vec3<V>& normal) {
    if (tile_.guides == nullptr || hn::AllFalse(d, lanes)) return;
    const Vec3<V> a = in_guide_units(d, albedo), n = in_guide_units(d, normal);
    if (GuideSum* const sum = common_sum(d, lanes)) {
      sum->albedo[0] += total(d, lanes, a.x);
      sum->albedo[1] += total(d, lanes, a.y);
      sum->albedo[2] += total(d, lanes, a.z);
      sum->normal[0] += total(d, lanes, n.x);
      sum->normal[1] += total(d, lanes, n.y);
      sum->normal[2] += total(d, lanes, n.z);
      return;
    }
    const Stored color(d, a), along(d, n);
    each_sum(d, lanes, [&](GuideSum& sum, int i) {
      for (int k = 0; k < 3; ++k) {
        sum.albedo[k] += static_cast<std::int64_t>(color.v[k][i]);
        sum.normal[k] += static_cast<std::int64_t>(along.v[k][i]);
      }
    });
  }

  /// Adds the reciprocal distances of first hits to the tile's sums.
  HWY_INLINE void inverse_depth(D d, hn::Mask<D> hit, V distance) {
    if (tile_.guides == nullptr || hn::AllFalse(d, hit)) return;
    const V inverse = min(1 / distance, kLargestInverseDepth);
    if (GuideSum* const sum = common_sum(d, hit)) {
      // Splits the fixed-point number into two parts, so that sums over the lanes are exact.
      const V scaled = inverse * 0x1p20, high = hn::Trunc(scaled), low = hn::Trunc((scaled - high) * 0x1p40);
      sum->inverse_depth += static_cast<Int128>(total(d, hit, high)) * (std::int64_t{1} << 40) + total(d, hit, low);
      return;
    }
    HWY_ALIGN hn::TFromD<D> stored[kMax];
    hn::Store(inverse, d, stored);
    each_sum(d, hit,
             [&](GuideSum& sum, int i) { sum.inverse_depth += to_fixed_point(static_cast<double>(stored[i])); });
  }

 private:
  static constexpr std::size_t kMax = hn::MaxLanes(D());
  /// Pixel and sample of each lane.
  struct Names {
    HWY_ALIGN Id pixel[kMax];
    HWY_ALIGN Id sample[kMax];
    HWY_INLINE explicit Names(const Recorder& of) {
      hn::Store(of.pixels_, IdTag<D>(), pixel);
      hn::Store(of.samples_, IdTag<D>(), sample);
    }
  };
  struct Stored {
    HWY_ALIGN hn::TFromD<D> v[3][kMax];
    HWY_INLINE Stored(D d, const Vec3<V>& from) {
      hn::Store(from.x, d, v[0]);
      hn::Store(from.y, d, v[1]);
      hn::Store(from.z, d, v[2]);
    }
    HWY_INLINE math::Vec3d lane(int i) const {
      return {static_cast<double>(v[0][i]), static_cast<double>(v[1][i]), static_cast<double>(v[2][i])};
    }
  };
  /// Converts guides to integers in units of kGuideUnit, clamped to 32 bits.
  static HWY_INLINE Vec3<V> in_guide_units(D d, const Vec3<V>& v) {
    const auto limit = set(d, 1.75);
    const auto units = set(d, 1 / kGuideUnit);
    const auto convert = [&](V x) { return hn::Trunc(max(-limit, min(x, limit)) * units); };
    return {convert(v.x), convert(v.y), convert(v.z)};
  }
  /// The sum over some lanes.
  ///
  /// Domain     integers below 2^49, so that the order of addition changes no bit
  static HWY_INLINE std::int64_t total(D d, hn::Mask<D> lanes, V integers) {
    const V masked = hn::IfThenElseZero(lanes, integers);
    if constexpr (std::is_same_v<hn::TFromD<D>, double> || kMax == 1) {
      return static_cast<std::int64_t>(hn::GetLane(hn::SumOfLanes(d, masked)));
    } else {
      const hn::Rebind<double, hn::Half<D>> dd;
      const auto sums =
          hn::PromoteTo(dd, hn::LowerHalf(masked)) + hn::PromoteTo(dd, hn::UpperHalf(hn::Half<D>(), masked));
      return static_cast<std::int64_t>(hn::GetLane(hn::SumOfLanes(dd, sums)));
    }
  }
  /// The sum that all lanes belong to; null if they belong to several.
  HWY_INLINE GuideSum* common_sum(D d, hn::Mask<D> lanes) const {
    const IdTag<D> du;
    const Id pixel = hn::GetLane(pixels_), sample = hn::GetLane(samples_);
    const auto half = [&](Ids samples) { return hn::And(samples, set(du, Sampler::kSecondHalf)); };
    const auto same = hn::And(pixels_ == hn::Set(du, pixel), half(samples_) == half(hn::Set(du, sample)));
    return hn::AllTrue(d, hn::Or(hn::Not(lanes), hn::RebindMask(d, same))) ? &sum_of(pixel, sample) : nullptr;
  }
  HWY_INLINE GuideSum& sum_of(Id pixel, Id sample) const {
    return tile_.guides[tile_.index(place_of(pixel, scene_), sample)];
  }
  /// Calls `add(sum, lane)` for each lane.
  template <class Add>
  HWY_INLINE void each_sum(D d, hn::Mask<D> lanes, Add add) const {
    const Names names(*this);
    each_lane(d, lanes, [&](int i) { add(sum_of(names.pixel[i], names.sample[i]), i); });
  }
  /// The index of a lane's record within the tile.
  HWY_INLINE std::int64_t index(const Names& names, int lane) const {
    return tile_.record_index(place_of(names.pixel[lane], scene_), names.sample[lane]);
  }
  template <class Do>
  HWY_INLINE void each(D d, hn::Mask<D> lanes, Do what) {
    const Names names(*this);
    each_lane(d, lanes, [&](int lane) { what(tile_.records[index(names, lane)], lane); });
  }

  const SceneView& scene_;
  const Tile& tile_;
  Ids pixels_, samples_;
};

/// Updates the history of paths that a surface has scattered.
///
/// `has_lobes`  true if the lobe and the indirect bit are needed
template <class D>
HWY_INLINE hn::Vec<IdTag<D>> continued(D d, hn::Vec<IdTag<D>> history, const Surface<D>& at,
                                       const Vec3<hn::Vec<D>>& direction, std::uint32_t depth, bool has_lobes) {
  const IdTag<D> du;
  const auto ids = [&](unsigned v) { return set(du, v); };
  const auto where = [&](hn::Mask<D> lanes, hn::Vec<IdTag<D>> then) {
    return hn::IfThenElseZero(hn::RebindMask(du, lanes), then);
  };
  const auto delta = where(is_delta(d, at), hn::And(history, ids(kOnlyDeltaBit)));
  if (!has_lobes) return delta;
  const auto passes = is_transmitted(d, at, direction);
  if (depth > 0) {
    const auto lobe = hn::And(history, ids(kLobeBits));
    const auto through = hn::And(passes, hn::RebindMask(d, lobe == ids(kTransmission)));
    const auto indirect = hn::Or(hn::And(history, ids(kIndirectBit)), where(hn::Not(through), ids(kIndirectBit)));
    return hn::Or(hn::Or(lobe, indirect), delta);
  }
  const auto lobe =
      select(hn::RebindMask(du, passes), ids(kTransmission),
             select(hn::RebindMask(du, has_trait<&MaterialTraits::is_specular>(d, at)), ids(kSpecular), ids(kDiffuse)));
  return hn::Or(lobe, delta);
}

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
