// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace orrery::base {

/// Bytes of the longest file name that the common file systems store.
inline constexpr std::size_t kLongestFileName = 255;

/// The longest prefix of at most `bytes` bytes that does not end inside a UTF-8 character: some file systems refuse
/// names that are not UTF-8.
std::string_view utf8_prefix(std::string_view text, std::size_t bytes);

/// `stem` + `suffix` as the name of a companion file, such as a checkpoint. Where that is longer than kLongestFileName
/// the stem is shortened and ends in a digest of the whole stem, so that different stems keep different names.
///
/// Domain     the suffix is shorter than half of a name
std::string companion_name(std::string_view stem, std::string_view suffix);

}  // namespace orrery::base
