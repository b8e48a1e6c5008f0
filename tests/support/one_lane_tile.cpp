// SPDX-License-Identifier: Apache-2.0
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "support/one_lane_tile.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target:
#include <hwy/highway.h>

#include "kernel/render_tile-inl.h"
#include "support/best.h"
#include "support/tile_functions.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::test::HWY_NAMESPACE {

namespace k = kernel::HWY_NAMESPACE;
using One = hwy::HWY_NAMESPACE::FixedTag<double, 1>;

kernel::RenderTile one_lane_instance() { return k::render_tile<One, k::Loop{kernel::Precision::kExact}>; }

}  // namespace orrery::test::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace orrery::test {

HWY_EXPORT(one_lane_instance);

kernel::RenderTile one_lane_tile_function() { return ORRERY_BEST(one_lane_instance)(); }

}  // namespace orrery::test
#endif
