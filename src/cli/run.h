// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace orrery::cli {

class Command;

/// The whole program: parses argv, runs the command, prints errors.
///
/// Result     the exit status; see base::exit_status
int run(int argc, const char* const* argv);

/// The first option that is written as `--name=`, without a value, as happens with an unset variable; empty if there is
/// none. The parser would take the next word as its value.
///
/// `words`    argv without the program's name
std::string option_without_value(const std::vector<std::string>& words);

/// The message for a wrong command line: what is wrong and what to type instead.
///
/// Domain     `words` are argv without the program's name; parsing them in `program` threw `error`
std::string usage_message(const CLI::App& program, const CLI::ParseError& error, const std::vector<std::string>& words);

/// Parses words as the arguments of a command with the options that `add_options` adds, and calls `use` while the
/// command exists.
///
/// Errors     base::Error(kUsage); those of `use`
void parse_words(std::vector<std::string> words, const std::function<void(Command&)>& add_options,
                 const std::function<void()>& use);

}  // namespace orrery::cli
