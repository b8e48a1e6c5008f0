// SPDX-License-Identifier: Apache-2.0
#include "kernel/render_tile.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernel/exact_tile.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target:
#include <hwy/highway.h>

#include "kernel/render_tile-inl.h"
#include "math/dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

RenderTile exact_instance(bool full) { return instance<hn::ScalableTag<double>, Precision::kExact>(full); }

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace orrery::kernel {

HWY_EXPORT(exact_instance);

RenderTile exact_tile_function(bool full) { return ORRERY_BEST(exact_instance)(full); }

}  // namespace orrery::kernel
#endif
