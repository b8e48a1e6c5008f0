// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace orrery::base {

enum class Severity { kError, kWarning };

/// One thing that is wrong (or doubtful) in a file or on the command line, with its place and its remedy.
struct Diagnostic {
  Severity severity = Severity::kError;
  std::string file;         ///< path as the user gave it; of the command line the option: "--samples"
  int line = 0;             ///< 1-based; 0 where there is no line (a binary file, a whole file)
  int column = 0;           ///< 1-based, in bytes of the line; 0 where there is no source line
  int width = 1;            ///< bytes to underline from `column`
  std::string text;         ///< what is wrong: names the key, the value and the allowed range
  std::string source_line;  ///< the line or the words of the command line that are wrong; empty where there is none
  std::string remedy;       ///< "did you mean `samples`?" and the like; may be empty
};

/// The finding as the user reads it: `file:line:column: error: text; remedy`, the source line, a caret. Without a line
/// there is no column either: `--samples: error: text`.
///
/// Result     several lines, each ended by a newline; bytes that would command a terminal are shown as question marks
std::string formatted(const Diagnostic& diagnostic);

}  // namespace orrery::base
