// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

namespace orrery::job {

/// Checks that pictures have known extensions, and that their formats hold that many bits in a channel.
///
/// Domain     `bits` of display formats, 0: the default
/// Errors     base::Error(kUsage)
void check_formats(const std::vector<std::filesystem::path>& pictures, int bits);

}  // namespace orrery::job
