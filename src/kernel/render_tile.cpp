// SPDX-License-Identifier: Apache-2.0
#include "kernel/render_tile.h"

#include "kernel/extended_tile.h"
#include "kernel/lit_tile.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernel/render_tile.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target:
#include <hwy/highway.h>

#include "kernel/render_tile-inl.h"
#include "math/dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

template <Precision kPrecision, bool kRecords>
RenderTile instance(bool moves) {
  using D = hn::ScalableTag<double>;
  return moves ? render_tile<D, Loop{kPrecision, kRecords, true}, PathStream>
               : render_tile<D, Loop{kPrecision, kRecords, false}, PathStream>;
}
template <bool kRecords>
RenderTileFast fast_instance(bool moves) {
  using D = hn::ScalableTag<float>;
  return moves ? render_tile<D, Loop{Precision::kFast, kRecords, true}, PathStreamFast>
               : render_tile<D, Loop{Precision::kFast, kRecords, false}, PathStreamFast>;
}

RenderTile render_instance(bool moves, Precision precision) {
  return precision == Precision::kBook ? instance<Precision::kBook, false>(moves)
                                       : instance<Precision::kExact, false>(moves);
}
RenderTile record_instance(bool moves) { return instance<Precision::kExact, true>(moves); }
RenderTileFast render_fast_instance(bool moves) { return fast_instance<false>(moves); }
RenderTileFast record_fast_instance(bool moves) { return fast_instance<true>(moves); }

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace orrery::kernel {

HWY_EXPORT(render_instance);
HWY_EXPORT(record_instance);
HWY_EXPORT(render_fast_instance);
HWY_EXPORT(record_fast_instance);

namespace {

/// Whether the extended loop renders these features. Precision::kBook is for comparison only and has no loop of its own
/// for layers and lights.
bool is_extended(const Features& features, bool records, Precision precision) {
  return features.extended || (precision == Precision::kBook && (records || features.lit));
}

}  // namespace

RenderTile render_tile_function(const Features& features, Precision precision) {
  if (is_extended(features, false, precision)) return extended_tile_function(false, precision);
  if (features.lit) return lit_tile_function(false);
  return ORRERY_BEST(render_instance)(features.motion, precision);
}
RenderTileFast render_tile_fast_function(const Features& features) {
  if (features.extended) return extended_tile_fast_function(false);
  if (features.lit) return lit_tile_fast_function(false);
  return ORRERY_BEST(render_fast_instance)(features.motion);
}

RenderTile record_tile_function(const Features& features, Precision precision) {
  if (is_extended(features, true, precision)) return extended_tile_function(true, precision);
  if (features.lit) return lit_tile_function(true);
  return ORRERY_BEST(record_instance)(features.motion);
}
RenderTileFast record_tile_fast_function(const Features& features) {
  if (features.extended) return extended_tile_fast_function(true);
  if (features.lit) return lit_tile_fast_function(true);
  return ORRERY_BEST(record_fast_instance)(features.motion);
}

}  // namespace orrery::kernel
#endif
