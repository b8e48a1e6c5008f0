// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hwy/highway.h>

#include <cstddef>

#include "math/dispatch.h"

/// Pointer to the instance of an HWY_EXPORTed function for the best enabled instruction set. The table has one entry if
/// only one is compiled.
#define ORRERY_BEST(function)                                                                                       \
  (HWY_DISPATCH_TABLE(function)[sizeof(HWY_DISPATCH_TABLE(function)) / sizeof(HWY_DISPATCH_TABLE(function)[0]) == 1 \
                                    ? 0                                                                             \
                                    : orrery::test::target_index()])

namespace orrery::test {

/// Index of the best enabled instruction set in Highway's tables.
inline std::size_t target_index() {
  hwy::ChosenTarget chosen;
  chosen.Update(math::target_choice().enabled());
  return chosen.GetIndex();
}

}  // namespace orrery::test
