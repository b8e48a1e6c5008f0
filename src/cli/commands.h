// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

#include <functional>

namespace orrery::cli {

/// A command adds itself to the program and says what to run once argv is read.
///
/// What it runs prints results to stdout, messages to stderr, and throws base::Error.
using Action = std::function<int()>;
void add_render(CLI::App& program, Action& action);
void add_info(CLI::App& program, Action& action);
void add_check(CLI::App& program, Action& action);
void add_generate(CLI::App& program, Action& action);
void add_develop(CLI::App& program, Action& action);

}  // namespace orrery::cli
