// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace orrery::cli {

/// Prints messages to stderr as JSON from now on, so that all lines are JSON beside --progress json.
void use_json_messages();

/// A message as it is printed: unchanged, or as a line {"message": "..."}.
///
/// Domain     whole lines
std::string printed_message(const std::string& text);

/// Prints a message to stderr, and to the log if it is open.
///
/// Domain     whole lines
void print_message(const std::string& text);

/// Writes a message to the log only, if it is open.
void log_message(const std::string& text);

/// Opens the log. Each message line is appended to it with UTC time and process id. Lines are appended atomically, so
/// that several processes can share a log.
///
/// Errors     base::Error(kCannotCreate)
void open_log(const std::filesystem::path& file);

}  // namespace orrery::cli
