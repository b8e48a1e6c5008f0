// SPDX-License-Identifier: Apache-2.0
#include "kernel/render_tile.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernel/fast_tile.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target:
#include <hwy/highway.h>

#include "kernel/render_tile-inl.h"
#include "math/dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

RenderTile fast_instance(bool full) { return instance<hn::ScalableTag<float>, Precision::kFast>(full); }

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace orrery::kernel {

HWY_EXPORT(fast_instance);

RenderTile fast_tile_function(bool full) { return ORRERY_BEST(fast_instance)(full); }

}  // namespace orrery::kernel
#endif
