// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "base/text.h"

namespace orrery::job {

using base::append;
using base::bytes_text;

/// JSON for people and programs: indented, ended by a newline. Bytes of file names that are no UTF-8, which JSON cannot
/// hold, become replacement characters.
std::string json_text(const nlohmann::json& value);

}  // namespace orrery::job
