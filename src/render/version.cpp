// SPDX-License-Identifier: Apache-2.0
#include "render/version.h"

#include <tbb/version.h>

namespace orrery::render {

std::string tbb_version() { return TBB_runtime_version(); }

}  // namespace orrery::render
