// SPDX-License-Identifier: Apache-2.0
#include "math/dispatch.h"

namespace orrery::math {

TargetChoice::TargetChoice()
    : available_((0 ORRERY_IF_AVX3(| HWY_AVX3) ORRERY_IF_AVX2(| HWY_AVX2) ORRERY_IF_SSE4(| HWY_SSE4)
                      ORRERY_IF_STATIC(| HWY_STATIC_TARGET)) &
                 static_cast<std::int64_t>(hwy::SupportedTargets())) {}

TargetChoice& target_choice() {
  static TargetChoice choice;
  return choice;
}

}  // namespace orrery::math
