// SPDX-License-Identifier: Apache-2.0
#include "kernel/render_tile.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernel/book_tile.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target:
#include <hwy/highway.h>

#include "kernel/render_tile-inl.h"
#include "math/dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

RenderTile book_instance() { return render_tile<hn::FixedTag<double, 1>, Loop{Precision::kBook, true}>; }

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace orrery::kernel {

HWY_EXPORT(book_instance);

RenderTile book_tile_function() { return ORRERY_BEST(book_instance)(); }

}  // namespace orrery::kernel
#endif
