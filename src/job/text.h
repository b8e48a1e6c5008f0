// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "base/text.h"

namespace orrery::job {

using base::bytes_text;

/// JSON, indented, with a final newline. Bytes that are not UTF-8, as file names may have, become replacement
/// characters.
std::string json_text(const nlohmann::json& value);

}  // namespace orrery::job
