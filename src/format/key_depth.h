// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "format/source_text.h"

namespace orrery::format {

/// Maximum number of parts in a dotted key; scenes need three. The TOML library creates a table per part and destroys
/// tables recursively, so that a key of ten thousand parts would overflow the stack.
inline constexpr int kDeepestKey = 8;

/// Finds the first key with more than kDeepestKey parts in a TOML text.
///
/// Domain     any bytes; after invalid TOML, where parsing stops, the result is meaningless
/// Result     location of the first excess dot; line 0 if there is no such key; text_name is not set
Place too_deep_key(std::string_view text);

}  // namespace orrery::format
