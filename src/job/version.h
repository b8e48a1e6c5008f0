// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace orrery::job {

/// Version of the program, e.g. "1.0.0".
std::string program_version();

/// Names and versions of all libraries that the program uses, except the command line's.
std::vector<std::pair<std::string, std::string>> library_versions();

}  // namespace orrery::job
