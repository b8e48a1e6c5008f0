// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "format/source_text.h"

namespace orrery::format {

/// Most parts of a dotted key: a scene needs three. The library makes a table for each part and takes tables down one
/// inside of the other, so that a key of some ten thousand parts would overflow the stack.
inline constexpr int kDeepestKey = 8;

/// The first key of a TOML text that has more than kDeepestKey parts.
///
/// Result     line 0 where there is none; text_name is not set
/// Domain     any bytes; after what is no TOML the answer means nothing, and nobody reads on there
Place too_deep_key(std::string_view text);

}  // namespace orrery::format
