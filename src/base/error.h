// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "base/diagnostic.h"

namespace orrery::base {

/// What went wrong, in the classes that a caller can act on; each is one exit status of the program.
enum class ErrorKind {
  kInternal,      ///< a broken promise of our own code (exit 1)
  kNoMemory,      ///< more memory is needed than there is (exit 1)
  kUsage,         ///< the request itself makes no sense (exit 2)
  kBadData,       ///< a scene or data file says something wrong (exit 65)
  kMissingInput,  ///< an input cannot be opened (exit 66)
  kCannotCreate,  ///< an output cannot be created (exit 73)
  kIo,            ///< reading or writing failed midway (exit 74)
  kStopped,       ///< stopped early on request; nothing was wrong (exit 75)
};

/// The one exception type of all cold paths.
///
/// A foreign library's error is translated into this once, at the edge of the room that owns the library. Where a
/// file's text caused it, `findings` hold every place that is wrong, not only the first.
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

}  // namespace orrery::base
