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

template <bool kRecords, bool kMoves>
RenderTile instance(Precision precision) {
  using D = hn::ScalableTag<double>;
  if (precision == Precision::kBook) return render_tile<D, Loop{Precision::kBook, kRecords, kMoves}, PathStream>;
  return render_tile<D, Loop{Precision::kExact, kRecords, kMoves}, PathStream>;
}
template <bool kRecords, bool kMoves>
RenderTileFast fast_instance() {
  return render_tile<hn::ScalableTag<float>, Loop{Precision::kFast, kRecords, kMoves}, PathStreamFast>;
}

RenderTile render_instance(bool moves, Precision precision) {
  return moves ? instance<false, true>(precision) : instance<false, false>(precision);
}
RenderTile record_instance(bool moves, Precision precision) {
  return moves ? instance<true, true>(precision) : instance<true, false>(precision);
}
RenderTileFast render_fast_instance(bool moves) {
  return moves ? fast_instance<false, true>() : fast_instance<false, false>();
}
RenderTileFast record_fast_instance(bool moves) {
  return moves ? fast_instance<true, true>() : fast_instance<true, false>();
}

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace orrery::kernel {

HWY_EXPORT(render_instance);
HWY_EXPORT(record_instance);
HWY_EXPORT(render_fast_instance);
HWY_EXPORT(record_fast_instance);

RenderTile render_tile_function(const Features& features, Precision precision) {
  if (features.extended) return extended_tile_function(false, precision);
  if (features.lit) return lit_tile_function(false, precision);
  return ORRERY_BEST(render_instance)(features.motion, precision);
}
RenderTileFast render_tile_fast_function(const Features& features) {
  if (features.extended) return extended_tile_fast_function(false);
  if (features.lit) return lit_tile_fast_function(false);
  return ORRERY_BEST(render_fast_instance)(features.motion);
}

RenderTile record_tile_function(const Features& features, Precision precision) {
  if (features.extended) return extended_tile_function(true, precision);
  if (features.lit) return lit_tile_function(true, precision);
  return ORRERY_BEST(record_instance)(features.motion, precision);
}
RenderTileFast record_tile_fast_function(const Features& features) {
  if (features.extended) return extended_tile_fast_function(true);
  if (features.lit) return lit_tile_fast_function(true);
  return ORRERY_BEST(record_fast_instance)(features.motion);
}

}  // namespace orrery::kernel
#endif
