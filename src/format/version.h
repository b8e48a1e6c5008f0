// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace orrery::format {

/// The version of toml++ in use.
std::string toml_version();

}  // namespace orrery::format
