// SPDX-License-Identifier: Apache-2.0
// Instantiates installed SIMD code (-inl.h) in an external program.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernel_text.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target:
#include <hwy/highway.h>

#include "math/dispatch.h"
#include "math/functions-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::math::HWY_NAMESPACE {
double quarter_turn() {
  const hn::ScalableTag<double> d;
  return hn::GetLane(sin_cos_turn(d, hn::Set(d, 0.25)).sin);
}
}  // namespace orrery::math::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace orrery::math {
HWY_EXPORT(quarter_turn);
}
double sine_of_quarter_turn() { return ORRERY_BEST(orrery::math::quarter_turn)(); }
#endif
