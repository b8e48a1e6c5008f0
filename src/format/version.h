// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace orrery::format {

/// Returns the version of toml++.
std::string toml_version();

}  // namespace orrery::format
