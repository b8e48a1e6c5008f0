// SPDX-License-Identifier: Apache-2.0
#include "kernel/lit_tile.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernel/lit_tile.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target:
#include <hwy/highway.h>

#include "kernel/render_tile-inl.h"
#include "math/dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

template <Precision kPrecision, bool kRecords>
constexpr Loop kLit{kPrecision, kRecords, true, true, false};

RenderTile lit_instance(bool records) {
  using D = hn::ScalableTag<double>;
  return records ? render_tile<D, kLit<Precision::kExact, true>, PathStream>
                 : render_tile<D, kLit<Precision::kExact, false>, PathStream>;
}
RenderTileFast lit_fast_instance(bool records) {
  using D = hn::ScalableTag<float>;
  return records ? render_tile<D, kLit<Precision::kFast, true>, PathStreamFast>
                 : render_tile<D, kLit<Precision::kFast, false>, PathStreamFast>;
}

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace orrery::kernel {

HWY_EXPORT(lit_instance);
HWY_EXPORT(lit_fast_instance);

RenderTile lit_tile_function(bool records) { return ORRERY_BEST(lit_instance)(records); }
RenderTileFast lit_tile_fast_function(bool records) { return ORRERY_BEST(lit_fast_instance)(records); }

}  // namespace orrery::kernel
#endif
