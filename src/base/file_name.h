// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace orrery::base {

/// Maximum length of a file name on common file systems, bytes.
inline constexpr std::size_t kLongestFileName = 255;

/// Returns the folder that holds a file.
std::filesystem::path folder_of(const std::filesystem::path& file);

/// Returns the extension of a file in lower case: ".ply". Extensions are compared ignoring case.
std::string extension(const std::filesystem::path& file);

/// Returns the longest prefix of at most `bytes` bytes that does not split a UTF-8 character: some file systems refuse
/// names that are not valid UTF-8.
std::string_view utf8_prefix(std::string_view text, std::size_t bytes);

/// Returns `stem` + `suffix` as the name of a companion file, such as a checkpoint. If that exceeds kLongestFileName,
/// the stem is truncated and a digest of the whole stem appended, so that different stems keep different names.
///
/// Domain     a suffix shorter than kLongestFileName / 2
std::string companion_name(std::string_view stem, std::string_view suffix);

}  // namespace orrery::base
