// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

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
/// Result     one or more lines, each ended by a newline; see printable() for control characters
std::string formatted(const Diagnostic& diagnostic);

/// Formats a warning that has no location: "warning: TEXT", ended by a newline.
std::string warning_line(std::string_view text);

/// Kinds of errors that a caller can distinguish; exit_status() maps them to the exit status of the program.
enum class ErrorKind {
  kInternal,      ///< a bug in orrery, or its installation is incomplete (exit 70)
  kNoMemory,      ///< not enough memory (exit 71)
  kUsage,         ///< the request is invalid (exit 2)
  kBadData,       ///< a scene or data file is invalid (exit 65)
  kMissingInput,  ///< an input cannot be opened (exit 66)
  kCannotCreate,  ///< an output cannot be created (exit 73)
  kIo,            ///< reading or writing failed (exit 74)
  kStopped,       ///< stopped early on request; not a failure (exit 75)
};

/// The exception type of all cold paths.
///
/// The room that owns a third-party library translates the library's errors into this type. For errors in a file,
/// `diagnostics` holds all of them, not only the first.
class Error : public std::runtime_error {
 public:
  Error(ErrorKind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}
  Error(ErrorKind kind, const std::string& message, std::vector<Diagnostic> diagnostics)
      : std::runtime_error(message), kind_(kind), diagnostics_(std::move(diagnostics)) {}

  ErrorKind kind() const noexcept { return kind_; }
  const std::vector<Diagnostic>& diagnostics() const noexcept { return diagnostics_; }

 private:
  ErrorKind kind_;
  std::vector<Diagnostic> diagnostics_;
};

/// An Error of the system for a file. It keeps both, for callers that report them separately.
class FileError : public Error {
 public:
  /// `message`  names the file and the reason
  /// `number`   errno
  FileError(ErrorKind kind, const std::string& message, std::filesystem::path file, int number,
            std::vector<Diagnostic> diagnostics = {})
      : Error(kind, message, std::move(diagnostics)), file_(std::move(file)), number_(number) {}

  const std::filesystem::path& file() const noexcept { return file_; }
  int number() const noexcept { return number_; }

 private:
  std::filesystem::path file_;
  int number_;
};

/// Throws a FileError of kind kIo.
[[noreturn]] inline void fail_to_write(const std::filesystem::path& file, int number) {
  throw FileError(ErrorKind::kIo, "writing " + file.string() + " failed: " + std::strerror(number), file, number);
}

/// Throws an Error of kind kUsage.
[[noreturn]] inline void refuse(const std::string& message) { throw Error(ErrorKind::kUsage, message); }

/// Returns the program's exit status for a kind of error: those of sysexits.h; stable, documented in the man page. None
/// is 1, which `compare` returns if images differ.
constexpr int exit_status(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::kInternal: return 70;
    case ErrorKind::kNoMemory: return 71;
    case ErrorKind::kUsage: return 2;
    case ErrorKind::kBadData: return 65;
    case ErrorKind::kMissingInput: return 66;
    case ErrorKind::kCannotCreate: return 73;
    case ErrorKind::kIo: return 74;
    case ErrorKind::kStopped: return 75;
  }
  return 70;
}

}  // namespace orrery::base
