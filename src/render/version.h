// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace orrery::render {

/// The version of oneTBB in use.
std::string tbb_version();

}  // namespace orrery::render
