// SPDX-License-Identifier: Apache-2.0
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "support/one_lane_tile.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target:
#include <hwy/highway.h>

#include "kernel/render_tile-inl.h"
#include "math/dispatch.h"
#include "support/tile_functions.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::test::HWY_NAMESPACE {

namespace k = kernel::HWY_NAMESPACE;
using One = hwy::HWY_NAMESPACE::FixedTag<double, 1>;

template <bool kMoves>
kernel::RenderTile instance(kernel::Precision precision) {
  using kernel::PathStream, kernel::Precision;
  if (precision == Precision::kBook) return k::render_tile<One, k::Loop{Precision::kBook, false, kMoves}, PathStream>;
  return k::render_tile<One, k::Loop{Precision::kExact, false, kMoves}, PathStream>;
}
kernel::RenderTile one_lane_instance(bool moves, kernel::Precision precision) {
  return moves ? instance<true>(precision) : instance<false>(precision);
}

}  // namespace orrery::test::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace orrery::test {

HWY_EXPORT(one_lane_instance);

kernel::RenderTile one_lane_tile_function(const kernel::Features& features, kernel::Precision precision) {
  return ORRERY_BEST(one_lane_instance)(features.motion, precision);
}

}  // namespace orrery::test
#endif
