// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace orrery::data {

/// Quotes a word of a file for a message; a long one is truncated: `word`.
inline std::string quoted_word(std::string_view word) {
  constexpr std::size_t kLongestShown = 40;
  return "`" + std::string(word.substr(0, kLongestShown)) + (word.size() > kLongestShown ? "..." : "") + "`";
}

}  // namespace orrery::data
