// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "format/overrides.h"

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
  /// Adds a text, or replaces the one of this name.
  ///
  /// `typed_lines`   number of lines at the beginning of the text that the user knows, if not all; a program wrote the
  ///                 others, and diagnostics omit their location
  void add(const std::string& name, std::string_view text, std::optional<int> typed_lines = {});

  /// Makes the overrides the lines of kOverrideName.
  ///
  /// Domain     they exist as long as this
  void set_overrides(const Overrides& overrides) { overrides_ = &overrides; }

  /// Returns the option of a line of kOverrideName: "--set", "--samples".
  const std::string& option_at(int line) const { return (*overrides_)[static_cast<std::size_t>(line) - 1].option; }

  /// Returns a diagnostic with location and source line; for an override, that is the command line: "--samples 0".
  base::Diagnostic diagnostic(base::Severity severity, const Place& place, std::string text,
                              std::string remedy = {}) const;

 private:
  struct Text {
    std::string bytes;
    std::optional<int> typed_lines;
    mutable std::vector<std::size_t> begins;  ///< offset of every kStride-th line; filled on first use
  };
  static std::string_view line_of(const Text& text, int line);
  static void point_into(const Override& override, const Place& place, base::Diagnostic& diagnostic);

  std::map<std::string, Text> texts_;
  const Overrides* overrides_ = nullptr;
};

/// Maximum size of a scene file, bytes: a million [[sphere]] tables. Larger scenes use points files.
inline constexpr std::uint64_t kLargestSceneFile = 256u << 20;

/// Throws base::Error(kUsage), which names the right command, if a text that is not a scene is a data file.
void refuse_data_file(const std::filesystem::path& file, std::string_view text);

/// Reads the text of a scene.
///
/// Errors     base::Error(kMissingInput) if it cannot be opened or is not a regular file, kBadData if it is larger than
///            `largest_bytes`, kIo if reading fails; those of refuse_data_file()
std::string read_file(const std::filesystem::path& file, std::uint64_t largest_bytes);

}  // namespace orrery::format
