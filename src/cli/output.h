// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "base/error.h"

namespace orrery::cli {

/// Whoever read stdout through a pipe has enough, as head(1) has: the command ends without a message.
struct ReaderLeft {};

/// Prints a result to stdout, all of it.
///
/// Errors     ReaderLeft; base::Error(kIo): a result that nobody got is a failure, also of a command that writes no
/// file
void print_result(const std::string& text);

/// An error in whole lines: each finding with its place, then the error itself.
std::string error_text(const base::Error& error);

/// Tells an error on stderr: each finding with its place, then the error itself.
///
/// Result     the exit status that it asks for
int print_error(const base::Error& error);

}  // namespace orrery::cli
