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

/// Name of the text that consists of all overrides, one per line.
inline constexpr const char* kOverrideName = "--set";

/// A range of characters in one line of a text.
///
/// Units      characters, not bytes, as in the TOML library
struct Place {
  std::string text_name;  ///< name of the text; empty: none
  int line = 0;           ///< 1-based; 0: none
  int column = 0;         ///< 1-based
  int width = 1;
};

/// The sources of a scene, the text of the file and the overrides, for quoting lines in diagnostics.
class SourceText {
 public:
  /// Adds a text.
  ///
  /// `is_generated`  a program wrote the text, so that its lines mean nothing to the user: diagnostics omit them
  void add(const std::string& name, std::string_view text, bool is_generated = false);

  /// Adds the next line of kOverrideName.
  ///
  /// `parsed`   the text as passed to the TOML library `inserted` ascending indices of the bytes in `parsed` that the
  /// user did not type
  void add_override(const Override& override, std::string parsed, std::vector<std::size_t> inserted);

  /// Returns the option of a line of kOverrideName: "--set", "--samples".
  const std::string& option_at(int line) const { return overrides_[static_cast<std::size_t>(line) - 1].option; }

  /// Returns a diagnostic with location and source line; for an override, that is the command line: "--samples 0".
  base::Diagnostic diagnostic(base::Severity severity, const Place& place, std::string text,
                              std::string remedy = {}) const;

 private:
  struct Text {
    std::string bytes;
    bool is_generated;
    mutable std::vector<std::size_t> begins;  ///< offset of every kStride-th line; filled on first use
  };
  struct ShownOverride {
    std::string option, shown, parsed;
    std::vector<std::size_t> inserted;
    std::size_t typed_begin = 0;  ///< index in the override's text of the option value that the user typed
  };
  static std::string_view line_of(const Text& text, int line);
  static void point_into(const ShownOverride& override, const Place& place, base::Diagnostic& diagnostic);

  std::map<std::string, Text> texts_;
  std::vector<ShownOverride> overrides_;
};

/// Maximum size of a scene file, bytes: a million [[sphere]] tables. Larger scenes use points files.
inline constexpr std::uint64_t kLargestSceneFile = 256u << 20;

/// Reads a whole file.
///
/// Errors     base::Error(kMissingInput) if it cannot be opened or is not a regular file, kBadData if it is larger than
///            `largest_bytes`, kIo if reading fails
std::string read_file(const std::filesystem::path& file, std::uint64_t largest_bytes);

}  // namespace orrery::format
