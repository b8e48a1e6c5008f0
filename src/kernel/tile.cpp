// SPDX-License-Identifier: Apache-2.0
// The instances of the path loop. The build compiles this file once for each instruction set and precision, of which it
// defines one of ORRERY_EXACT, ORRERY_FAST and ORRERY_BOOK: an instance takes many seconds.
#include "kernel/render_tile-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

#if defined(ORRERY_EXACT)
RenderTile exact_tile(bool full) { return instance<hn::ScalableTag<double>, Precision::kExact>(full); }
#elif defined(ORRERY_FAST)
RenderTile fast_tile(bool full) { return instance<hn::ScalableTag<float>, Precision::kFast>(full); }
#else
/// One lane and always full, since Precision::kBook is for comparison with the book.
RenderTile book_tile(bool) { return render_tile<hn::FixedTag<double, 1>, Loop{Precision::kBook, true}>; }
#endif

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
