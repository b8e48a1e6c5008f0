// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "cli/arguments.h"

namespace orrery::cli {

/// Runs a command after argv is parsed. Prints results to stdout and messages to stderr; throws base::Error.
///
/// Result     the exit status
using Action = std::function<int()>;

/// Adds one command to the program. Parsing sets `action` if argv names the command.
///
/// Domain     `action` outlives the parsing
void add_render(Command& program, Action& action);
void add_plot(Command& program, Action& action);
void add_merge(Command& program, Action& action);
void add_submit(Command& program, Action& action);
void add_check(Command& program, Action& action);
void add_info(Command& program, Action& action);
void add_compare(Command& program, Action& action);
void add_bench(Command& program, Action& action);
void add_study(Command& program, Action& action);
void add_generate(Command& program, Action& action);
void add_convert(Command& program, Action& action);
void add_develop(Command& program, Action& action);
void add_denoise(Command& program, Action& action);
void add_bake(Command& program, Action& action);
/// The hidden command that prints the manual page and shell completions, for the build. Added last.
void add_documents(Command& program, Action& action);

}  // namespace orrery::cli
