// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace orrery::base {

enum class Severity { kError, kWarning };

/// An error or warning about a file or the command line, with its location and remedy.
struct Diagnostic {
  Severity severity = Severity::kError;
  std::string file;         ///< path as given by the user, or command-line option: "--samples"
  int line = 0;             ///< 1-based; 0: no line (a binary file, or the whole file)
  int column = 0;           ///< 1-based, in bytes of the line; 0: no source line
  int width = 1;            ///< bytes to underline from `column`
  std::string text;         ///< what is wrong: the key, the value and the allowed range
  std::string source_line;  ///< the faulty line or command-line words; may be empty
  std::string remedy;       ///< what to do: "did you mean `samples`?"; may be empty
};

/// A diagnostic about a whole file.
Diagnostic file_diagnostic(Severity severity, std::string file, std::string text, std::string remedy = {});

/// Formats a diagnostic for the user: `file:line:column: error: text; remedy`, the source line, a caret. Without a
/// line, the column is omitted as well: `--samples: error: text`.
///
/// Result     one or more lines, each ended by a newline; control characters are replaced by question marks
std::string formatted(const Diagnostic& diagnostic);

/// Formats a warning that has no location: "warning: TEXT", ended by a newline.
std::string warning_line(std::string_view text);

}  // namespace orrery::base
