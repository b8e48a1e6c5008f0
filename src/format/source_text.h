// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostic.h"
#include "format/override.h"

namespace orrery::format {

/// The name of the text that all overrides together are, one line each.
inline constexpr const char* kOverrideName = "--set";

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
  void add(const std::string& name, std::string_view text);

  /// The next line of kOverrideName.
  ///
  /// `parsed` is what the TOML library is given for its text, `inserted` the bytes of it that nobody typed, ascending
  void add_override(const Override& override, std::string parsed, std::vector<std::size_t> inserted);

  /// The option that a line of kOverrideName comes from: "--set", "--samples".
  const std::string& option_at(int line) const { return overrides_[static_cast<std::size_t>(line) - 1].option; }

  /// A finding at a place, with its source line. Of an override it is the command line's: "--samples 0".
  base::Diagnostic diagnostic(base::Severity severity, const Place& place, std::string text,
                              std::string remedy = {}) const;

 private:
  struct Text {
    std::string bytes;
    mutable std::vector<std::size_t> begins;  ///< of each kStride-th line; made when the first line is asked for
  };
  struct ShownOverride {
    std::string option, shown, parsed;
    std::vector<std::size_t> inserted;
    std::size_t typed_begin = 0;  ///< in the override's text, of what the user typed behind the option
  };
  static std::string_view line_of(const Text& text, int line);
  static void point_into(const ShownOverride& override, const Place& place, base::Diagnostic& diagnostic);

  std::map<std::string, Text> texts_;
  std::vector<ShownOverride> overrides_;
};

/// Bytes of the largest scene file: a million [[sphere]] tables. Larger scenes have points files.
inline constexpr std::uint64_t kLargestSceneFile = 256u << 20;

/// A whole file as bytes.
///
/// Errors     base::Error(kMissingInput) where it cannot be opened or is not a regular file, kBadData where it is
///            larger than `largest_bytes`, kIo where reading fails
std::string read_file(const std::filesystem::path& file, std::uint64_t largest_bytes);

}  // namespace orrery::format
