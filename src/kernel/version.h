// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace orrery::kernel {

/// The version of Highway in use.
std::string highway_version();

}  // namespace orrery::kernel
