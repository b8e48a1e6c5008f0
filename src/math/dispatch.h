// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hwy/highway.h>

/// The instance of an HWY_EXPORTed function for the best instruction set that this processor has, as a pointer.
///
/// The table behind it is sized for all sets; its entry 0 would choose at every call, so the choice is made here, once.
#define ORRERY_BEST(function) \
  (hwy::GetChosenTarget().Update(hwy::SupportedTargets()), HWY_DISPATCH_TABLE(function)[hwy::GetChosenTarget().GetIndex()])
