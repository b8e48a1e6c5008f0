// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "base/error.h"

namespace orrery::cli {

/// Thrown if the reader of stdout, a pipe, has exited, as head(1) does. The command ends without a message.
struct BrokenPipe {};

/// Prints a result to stdout and flushes it.
///
/// Errors     BrokenPipe; base::Error(kIo) if stdout cannot be written
void print_result(const std::string& text);

/// An error as whole lines: each diagnostic with its location, then the error.
std::string error_text(const base::Error& error);

/// Prints error_text to stderr.
///
/// Result     the exit status of the error's kind
int print_error(const base::Error& error);

}  // namespace orrery::cli
