// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include <nlohmann/json_fwd.hpp>

namespace orrery::app {

/// printf at the end of a string, of any length.
[[gnu::format(printf, 2, 3)]] void append(std::string& out, const char* format, ...);

/// "49.4 MiB".
std::string bytes_text(std::uint64_t bytes);

/// JSON for people and programs: indented, ended by a newline. Bytes of file names that are no UTF-8, which JSON cannot
/// hold, become replacement characters.
std::string json_text(const nlohmann::json& value);

}  // namespace orrery::app
