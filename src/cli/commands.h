// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

#include <functional>

namespace orrery::cli {

/// What a command does once argv is read: prints results to stdout and messages to stderr, throws base::Error.
///
/// Result     the exit status
using Action = std::function<int()>;

/// Adds one command to the program; where argv names it, parsing puts what it does into `action`.
///
/// Domain     `action` outlives the parsing
void add_submit(CLI::App& program, Action& action);
void add_merge(CLI::App& program, Action& action);
void add_render(CLI::App& program, Action& action);
void add_info(CLI::App& program, Action& action);
void add_check(CLI::App& program, Action& action);
void add_generate(CLI::App& program, Action& action);
void add_develop(CLI::App& program, Action& action);
void add_bake(CLI::App& program, Action& action);
void add_compare(CLI::App& program, Action& action);
void add_bench(CLI::App& program, Action& action);
void add_study(CLI::App& program, Action& action);

}  // namespace orrery::cli
