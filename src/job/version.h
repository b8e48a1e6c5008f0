// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace orrery::job {

/// "0.1.0".
std::string program_version();

/// Name and version of every library that the program is made of, but for the command line's.
std::vector<std::pair<std::string, std::string>> library_versions();

}  // namespace orrery::job
