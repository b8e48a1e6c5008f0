// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <filesystem>

namespace orrery::support {

/// Returns the folder with particle data that is too large to commit; it may be missing, and tests skip then.
inline std::filesystem::path shared_data() {
  const char* const folder = std::getenv("ORRERY_TEST_DATA");
  return folder != nullptr ? std::filesystem::path(folder) : std::filesystem::path(ORRERY_ROOT) / "../shared/data";
}

}  // namespace orrery::support
