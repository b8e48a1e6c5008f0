// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace orrery::cli {

/// The innermost command that argv names; the program itself if it names none.
const CLI::App& innermost(const CLI::App& program);

/// The full name of a command: "orrery generate final".
std::string full_name(const CLI::App& command);

/// The first option that is written as `--name=`, without a value, as happens with an unset variable; empty if there is
/// none. The parser would take the next word as its value.
///
/// `words`    argv without the program's name
std::string option_without_value(const std::vector<std::string>& words);

/// The message for a wrong command line: what is wrong and what to type instead.
///
/// Domain     `words` are argv without the program's name; parsing them in `program` threw `error`
std::string usage_message(const CLI::App& program, const CLI::ParseError& error, const std::vector<std::string>& words);

}  // namespace orrery::cli
