// SPDX-License-Identifier: Apache-2.0
#include "kernel/version.h"

#include <hwy/highway.h>

namespace orrery::kernel {

std::string highway_version() {
  return std::to_string(HWY_MAJOR) + "." + std::to_string(HWY_MINOR) + "." + std::to_string(HWY_PATCH);
}

}  // namespace orrery::kernel
