// SPDX-License-Identifier: Apache-2.0
// Writes down what becomes of paths, for layers beside the beauty. Compiled once per instruction set.
#if defined(ORRERY_KERNEL_RECORD_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ORRERY_KERNEL_RECORD_INL_H_
#undef ORRERY_KERNEL_RECORD_INL_H_
#else
#define ORRERY_KERNEL_RECORD_INL_H_
#endif

#include <hwy/highway.h>

#include "kernel/render_tile.h"
#include "kernel/scatter-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

// What a path remembers of its way, in the bits of its `history`.
inline constexpr unsigned kLobeBits = 3;      ///< what the first surface did: 0 as long as there was none, or a Lobe
inline constexpr unsigned kOnlyDeltaBit = 4;  ///< nothing but sharp mirrors and glass so far
inline constexpr unsigned kIndirectBit = 8;   ///< scattered again, otherwise than by passing through glass
enum Lobe : unsigned { kDiffuse = 1, kSpecular = 2, kTransmission = 3 };

/// The records of the lanes of one vector.
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

  /// Paths begin: whatever the records held is forgotten.
  HWY_INLINE void begin(D d, hn::Mask<D> active) {
    each(d, active, [](PathRecord& r, int) { r = {}; });
  }

  /// The surfaces that camera rays have met.
  ///
  /// `times`    of the rays; null where nothing moves
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

  /// Light that has arrived.
  HWY_INLINE void light(D d, hn::Mask<D> lanes, const Vec3<V>& light, Ids history) {
    const IdTag<D> du;
    HWY_ALIGN Id way[kMax];
    Stored rgb(d, light);
    hn::Store(history, du, way);
    each(d, lanes, [&](PathRecord& r, int i) {
      const unsigned lobe = static_cast<unsigned>(way[i]) & kLobeBits;
      const bool direct = (static_cast<unsigned>(way[i]) & kIndirectBit) == 0;
      if (lobe != 0) r.group = static_cast<LightGroup>(2 * lobe - (direct ? 1 : 0));
      for (int k = 0; k < 3; ++k) r.light[k] = static_cast<double>(rgb.v[k][i]);
    });
  }

  /// What a denoiser is guided by.
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
  HWY_INLINE PathRecord& record(int lane) {
    const PixelPlace at = place_of(pixel_[lane], scene_);
    const auto count = static_cast<std::int64_t>(tile_.sample_end - tile_.sample_begin);
    const auto sample = static_cast<std::int64_t>(sample_[lane]) - tile_.sample_begin;
    return tile_.records[(std::int64_t{at.y - tile_.y} * tile_.width + (at.x - tile_.x)) * count + sample];
  }
  template <class Do>
  HWY_INLINE void each(D d, hn::Mask<D> lanes, Do what) {
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(d, lanes, bytes);
    for (unsigned bits = bytes[0] | unsigned{bytes[1]} << 8; bits != 0; bits &= bits - 1) {
      const int lane = static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero32(bits));
      what(record(lane), lane);
    }
  }

  const SceneView& scene_;
  const Tile& tile_;
  HWY_ALIGN Id pixel_[kMax];
  HWY_ALIGN Id sample_[kMax];
};

/// Lanes whose surface sends light on in one direction only.
template <class D>
HWY_INLINE hn::Mask<D> is_delta(D d, const Surface<D>& at) {
  const auto mirror = hn::And(is_kind(d, at.kind, MaterialKind::kMetal), at.fuzz == hn::Zero(d));
  return hn::Or(mirror, is_kind(d, at.kind, MaterialKind::kDielectric));
}

/// The history of paths behind the surfaces that they have just left.
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
