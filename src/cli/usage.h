// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace orrery::cli {

/// The command that argv has got into, the innermost one that was named; the program itself where none was.
const CLI::App& innermost(const CLI::App& program);

/// "orrery generate final": what has to be typed to get to a command.
std::string full_name(const CLI::App& command);

/// What is wrong with a command line, in words that name the remedy. The library says that something is too much;
/// people want to know what they should have typed.
///
/// Domain     `words` are argv without the program's name, `error` is what parsing them in `program` threw
std::string usage_message(const CLI::App& program, const CLI::ParseError& error, const std::vector<std::string>& words);

}  // namespace orrery::cli
