// SPDX-License-Identifier: Apache-2.0
#include "format/version.h"

#include <toml++/toml.h>

namespace orrery::format {

std::string toml_version() {
  return std::to_string(TOML_LIB_MAJOR) + "." + std::to_string(TOML_LIB_MINOR) + "." + std::to_string(TOML_LIB_PATCH);
}

}  // namespace orrery::format
