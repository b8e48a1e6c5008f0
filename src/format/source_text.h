// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "base/finding.h"

namespace orrery::format {

/// A stretch of one line of a text.
///
/// Units      characters, not bytes, as the TOML library counts
struct Place {
  std::string text_name;  ///< of the text it is in; empty where there is none
  int line = 0;           ///< from 1; 0 where there is none
  int column = 0;         ///< from 1
  int width = 1;
};

/// The texts that a scene is read from, the file and the overrides, to show their lines in findings.
class SourceText {
 public:
  /// Puts lines behind those that are there already under that name.
  void add(const std::string& name, std::string_view text);

  /// A finding at a place, with its source line.
  base::Finding finding(base::Severity severity, const Place& place, std::string text, std::string remedy = {}) const;

 private:
  struct Text {
    std::string bytes;
    mutable std::vector<std::size_t> begins;  ///< of each kStride-th line; made when the first line is asked for
  };
  static std::string_view line_of(const Text& text, int line);

  std::map<std::string, Text> texts_;
};

/// Bytes of the largest scene file: a million [[sphere]] tables. Larger scenes have points files.
inline constexpr std::uint64_t kLargestSceneFile = 256u << 20;

/// A whole file as bytes.
///
/// Errors     base::Error(kMissingInput) where it cannot be opened, kBadData where it is larger than `largest_bytes`,
///            kIo where reading fails
std::string read_file(const std::filesystem::path& file, std::uint64_t largest_bytes);

}  // namespace orrery::format
