// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace orrery::job {

/// Formats a value as indented JSON with a final newline. Bytes that are not UTF-8, possible in file names, become
/// replacement characters.
std::string json_text(const nlohmann::json& value);

}  // namespace orrery::job
