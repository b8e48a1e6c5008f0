// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"

namespace orrery::base {

/// Returns the program's exit status for a kind of error; stable, documented in the man page.
constexpr int exit_status(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::kInternal: return 1;
    case ErrorKind::kNoMemory: return 1;
    case ErrorKind::kUsage: return 2;
    case ErrorKind::kBadData: return 65;
    case ErrorKind::kMissingInput: return 66;
    case ErrorKind::kCannotCreate: return 73;
    case ErrorKind::kIo: return 74;
    case ErrorKind::kStopped: return 75;
  }
  return 1;
}

}  // namespace orrery::base
