// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "base/error.h"

namespace orrery::cli {

/// Prints a result to stdout and flushes it. A pipe whose reader has exited, as head(1) does, is not an error: the
/// reader has what it wanted.
///
/// Errors     base::Error(kIo) if stdout cannot be written
void print_result(const std::string& text);

/// Prints messages to stderr as JSON from now on, so that all lines are JSON beside --progress json.
void use_json_messages();

/// A message as it is printed: unchanged, or as a line {"message": "..."}.
///
/// Domain     whole lines
std::string printed_message(const std::string& text);

/// Prints a message to stderr.
///
/// Domain     whole lines
void print_message(const std::string& text);

/// An error as whole lines: each diagnostic with its location, then the error.
std::string error_text(const base::Error& error);

/// Prints error_text to stderr.
///
/// Result     the exit status of the error's kind
int print_error(const base::Error& error);

}  // namespace orrery::cli
