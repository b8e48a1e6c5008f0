// SPDX-License-Identifier: Apache-2.0
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "support/collecting_tile.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target:
#include <hwy/highway.h>

#include "kernel/render_tile-inl.h"
#include "math/dispatch.h"
#include "support/tile_functions.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::test::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
namespace k = kernel::HWY_NAMESPACE;

template <bool kRecords>
constexpr k::Loop kCollecting{kernel::Precision::kExact, kRecords, true, true};
template <bool kRecords>
constexpr k::Loop kCollectingFast{kernel::Precision::kFast, kRecords, true, true};

kernel::RenderTile collecting_instance(bool records) {
  using D = hn::ScalableTag<double>;
  return records ? k::render_tile<D, kCollecting<true>, kernel::PathStream>
                 : k::render_tile<D, kCollecting<false>, kernel::PathStream>;
}
kernel::RenderTileFast collecting_fast_instance(bool records) {
  using D = hn::ScalableTag<float>;
  return records ? k::render_tile<D, kCollectingFast<true>, kernel::PathStreamFast>
                 : k::render_tile<D, kCollectingFast<false>, kernel::PathStreamFast>;
}

}  // namespace orrery::test::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace orrery::test {

HWY_EXPORT(collecting_instance);
HWY_EXPORT(collecting_fast_instance);

kernel::RenderTile collecting_tile_function(bool records) { return ORRERY_BEST(collecting_instance)(records); }
kernel::RenderTileFast collecting_tile_fast_function(bool records) {
  return ORRERY_BEST(collecting_fast_instance)(records);
}

}  // namespace orrery::test
#endif
