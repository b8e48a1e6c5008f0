// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/arguments.h"

namespace orrery::cli {

// Each of these functions adds one command to the program. Commands print results to stdout and messages to stderr, and
// throw base::Error.

void add_render(Command& program);
void add_plot(Command& program);
void add_view(Command& program);
void add_merge(Command& program);
void add_submit(Command& program);
void add_check(Command& program);
void add_info(Command& program);
void add_compare(Command& program);
void add_bench(Command& program);
void add_study(Command& program);
void add_generate(Command& program);
void add_convert(Command& program);
void add_develop(Command& program);
void add_denoise(Command& program);
/// The hidden command that prints the manual page and shell completions, for the build. Added last.
void add_documents(Command& program);

}  // namespace orrery::cli
