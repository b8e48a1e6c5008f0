// SPDX-License-Identifier: Apache-2.0
#include "kernel/render_tile-inl.h"
#include "support/tile_functions.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::test::HWY_NAMESPACE {

namespace k = kernel::HWY_NAMESPACE;
using One = hwy::HWY_NAMESPACE::FixedTag<double, 1>;

kernel::RenderTile one_lane_instance() { return k::render_tile<One, k::Loop{kernel::Precision::kExact}>; }

}  // namespace orrery::test::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace orrery::test {

kernel::RenderTile one_lane_tile_function() { return HWY_NAMESPACE::one_lane_instance(); }

}  // namespace orrery::test
