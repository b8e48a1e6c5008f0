// SPDX-License-Identifier: Apache-2.0
// Recording of paths, for layers beside the beauty. Compiled once per instruction set.
#if defined(ORRERY_KERNEL_RECORD_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ORRERY_KERNEL_RECORD_INL_H_
#undef ORRERY_KERNEL_RECORD_INL_H_
#else
#define ORRERY_KERNEL_RECORD_INL_H_
#endif

#include <hwy/highway.h>

#include "kernel/compaction-inl.h"
#include "kernel/render_tile.h"
#include "kernel/scatter-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

// The bits of a path's `history`.
inline constexpr unsigned kLobeBits = 3;      ///< a FirstLobe, or 0 before the first surface
inline constexpr unsigned kOnlyDeltaBit = 4;  ///< only delta materials so far
inline constexpr unsigned kIndirectBit = 8;   ///< scattered again, other than by passing through glass
enum FirstLobe : unsigned { kDiffuse = 1, kSpecular = 2, kTransmission = 3 };

/// Writes the records of one vector of paths.
template <class D>
class Recorder {
 public:
  using V = hn::Vec<D>;
  using Ids = hn::Vec<IdTag<D>>;
  using Id = hn::TFromD<IdTag<D>>;

  HWY_INLINE Recorder(D d, const SceneView& scene, const Tile& tile, Ids pixels, Ids samples)
      : scene_(scene), tile_(tile) {
    hn::Store(pixels, IdTag<D>(), pixel_);
    hn::Store(samples, IdTag<D>(), sample_);
    (void)d;
  }

  /// Resets the records of paths that begin.
  HWY_INLINE void begin(D d, hn::Mask<D> active) {
    each(d, active, [](PathRecord& r, int) { r = {}; });
  }

  /// Records the first hits.
  ///
  /// `times`    of the rays; null if nothing moves
  HWY_INLINE void first_hit(D d, hn::Mask<D> hit, Ids spheres, const Vec3<V>& offset, const Vec3<V>& direction,
                            const hn::TFromD<D>* times) {
    const IdTag<D> du;
    HWY_ALIGN Id sphere[kMax];
    Stored at(d, offset), along(d, direction);
    hn::Store(spheres, du, sphere);
    each(d, hit, [&](PathRecord& r, int i) {
      r.sphere = static_cast<std::uint32_t>(sphere[i]);
      if (times != nullptr) r.time = static_cast<double>(times[i]);
      for (int k = 0; k < 3; ++k) {
        r.offset[k] = static_cast<double>(at.v[k][i]);
        r.direction[k] = static_cast<double>(along.v[k][i]);
      }
    });
  }

  /// Records the albedo at the first hits.
  HWY_INLINE void albedo(D d, hn::Mask<D> hit, const Vec3<V>& albedo) {
    Stored color(d, albedo);
    each(d, hit, [&](PathRecord& r, int i) {
      for (int k = 0; k < 3; ++k) r.albedo[k] = static_cast<float>(color.v[k][i]);
    });
  }

  /// Writes light events for radiance that paths gained.
  ///
  /// `groups`   light groups of the sources
  /// `unscattered`  the lobe of light that no surface has scattered
  HWY_INLINE void event(D d, hn::Mask<D> lanes, const Vec3<V>& light, Ids history, Ids groups, Lobe unscattered) {
    if (tile_.events == nullptr) return;
    const IdTag<D> du;
    HWY_ALIGN Id way[kMax], group[kMax];
    Stored rgb(d, light);
    hn::Store(history, du, way);
    hn::Store(groups, du, group);
    LightEvents& events = *tile_.events;
    if (events.end - events.next < kPacketSize) events.make_room(events);
    each_lane(d, lanes, [&](int i) {
      const unsigned lobe = static_cast<unsigned>(way[i]) & kLobeBits;
      const bool direct = (static_cast<unsigned>(way[i]) & kIndirectBit) == 0;
      LightEvent& e = *events.next++;
      for (int k = 0; k < 3; ++k) e.value[k] = static_cast<double>(rgb.v[k][i]);
      e.path = static_cast<std::uint32_t>(index(i));
      e.group = static_cast<std::uint16_t>(group[i]);
      e.lobe = lobe != 0 ? static_cast<Lobe>(2 * lobe - (direct ? 1 : 0)) : unscattered;
    });
  }

  /// Records the total radiance of paths that end.
  HWY_INLINE void light(D d, hn::Mask<D> lanes, const Vec3<V>& light) {
    Stored rgb(d, light);
    each(d, lanes, [&](PathRecord& r, int i) {
      for (int k = 0; k < 3; ++k) r.light[k] = static_cast<double>(rgb.v[k][i]);
    });
  }

  /// Records the denoiser guides.
  HWY_INLINE void guide(D d, hn::Mask<D> lanes, const Vec3<V>& albedo, const Vec3<V>& normal) {
    Stored color(d, albedo), n(d, normal);
    each(d, lanes, [&](PathRecord& r, int i) {
      for (int k = 0; k < 3; ++k) {
        r.guide_albedo[k] = static_cast<float>(color.v[k][i]);
        r.guide_normal[k] = static_cast<float>(n.v[k][i]);
      }
    });
  }

 private:
  static constexpr std::size_t kMax = hn::MaxLanes(D());
  struct Stored {
    HWY_ALIGN hn::TFromD<D> v[3][kMax];
    HWY_INLINE Stored(D d, const Vec3<V>& from) {
      hn::Store(from.x, d, v[0]);
      hn::Store(from.y, d, v[1]);
      hn::Store(from.z, d, v[2]);
    }
  };
  /// The index of a lane's record within the tile.
  HWY_INLINE std::int64_t index(int lane) const {
    const PixelPlace at = place_of(pixel_[lane], scene_);
    const auto count = static_cast<std::int64_t>(tile_.sample_end - tile_.sample_begin);
    const auto sample = static_cast<std::int64_t>(sample_[lane]) - tile_.sample_begin;
    return (std::int64_t{at.y - tile_.y} * tile_.width + (at.x - tile_.x)) * count + sample;
  }
  template <class Do>
  HWY_INLINE void each(D d, hn::Mask<D> lanes, Do what) {
    each_lane(d, lanes, [&](int lane) { what(tile_.records[index(lane)], lane); });
  }

  const SceneView& scene_;
  const Tile& tile_;
  HWY_ALIGN Id pixel_[kMax];
  HWY_ALIGN Id sample_[kMax];
};

/// Lanes whose material is delta: a sharp mirror or a dielectric.
template <class D>
HWY_INLINE hn::Mask<D> is_delta(D d, const Surface<D>& at) {
  const auto mirror = hn::And(is_kind(d, at.kind, MaterialKind::kMetal), at.fuzz == hn::Zero(d));
  return hn::Or(mirror, is_kind(d, at.kind, MaterialKind::kDielectric));
}

/// Updates the history of paths that a surface has scattered.
template <class D>
HWY_INLINE hn::Vec<IdTag<D>> continued(D d, hn::Vec<IdTag<D>> history, const Surface<D>& at,
                                       const Vec3<hn::Vec<D>>& direction, std::uint32_t depth) {
  const IdTag<D> du;
  using Id = hn::TFromD<decltype(du)>;
  const auto ids = [&](unsigned v) { return hn::Set(du, static_cast<Id>(v)); };
  const auto where = [&](hn::Mask<D> lanes, hn::Vec<IdTag<D>> then) {
    return hn::IfThenElseZero(hn::RebindMask(du, lanes), then);
  };
  const auto sharp = where(is_delta(d, at), hn::And(history, ids(kOnlyDeltaBit)));
  const auto glass = is_kind(d, at.kind, MaterialKind::kDielectric);
  const auto passes = hn::AndNot(at.same_side(d, direction), glass);
  if (depth > 0) {
    const auto lobe = hn::And(history, ids(kLobeBits));
    const auto through = hn::And(passes, hn::RebindMask(d, lobe == ids(kTransmission)));
    const auto indirect = hn::Or(hn::And(history, ids(kIndirectBit)), where(hn::Not(through), ids(kIndirectBit)));
    return hn::Or(hn::Or(lobe, indirect), sharp);
  }
  const auto metal = is_kind(d, at.kind, MaterialKind::kMetal);
  const auto lobe =
      hn::IfThenElse(hn::RebindMask(du, passes), ids(kTransmission),
                     hn::IfThenElse(hn::RebindMask(du, hn::Or(metal, glass)), ids(kSpecular), ids(kDiffuse)));
  return hn::Or(lobe, sharp);
}

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
