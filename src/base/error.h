// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "base/diagnostic.h"

namespace orrery::base {

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
