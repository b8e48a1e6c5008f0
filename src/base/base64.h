// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace orrery::base {

/// Encodes bytes in base64 with padding and without line breaks.
///
/// Result     4 characters for every 3 bytes, rounded up
/// Reference  rfc4648, section 4
std::string base64(std::string_view bytes);

}  // namespace orrery::base
