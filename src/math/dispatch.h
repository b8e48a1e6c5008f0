// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hwy/highway.h>

namespace orrery::math {

/// Finds out once which processor this is: asking is slow on virtual machines, where it leaves the machine.
inline void choose_target_once() {
  if (!hwy::GetChosenTarget().IsInitialized()) hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

}  // namespace orrery::math

/// The instance of an HWY_EXPORTed function for the best instruction set that this processor has, as a pointer.
///
/// The table behind it is sized for all sets; its entry 0 would choose at every call, so the choice is made here.
#define ORRERY_BEST(function) \
  (orrery::math::choose_target_once(), HWY_DISPATCH_TABLE(function)[hwy::GetChosenTarget().GetIndex()])
