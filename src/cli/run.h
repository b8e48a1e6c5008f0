// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace orrery::cli {

/// The whole program: parses argv, runs the command, prints errors.
///
/// Result     the exit status; see base/exit_status.h
int run(int argc, const char* const* argv);

}  // namespace orrery::cli
