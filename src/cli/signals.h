// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>

namespace orrery::cli {

/// Sets up signals at the start of the program. Writing to a closed pipe or beyond the file size limit becomes a failed
/// write. USR1 requests a checkpoint; all commands handle it, since a supervisor sends it to whatever is running.
/// Unblocks signals that the parent blocked. Signals ignored at the start of the process stay ignored.
void prepare_signals();

/// Makes INT, TERM and HUP request a stop. A second one ends the process at once with status 128 + its number, and
/// leaves no partial or temporary file. Signals ignored at the start of the process, e.g. HUP by nohup, stay ignored.
///
/// Result     set by the first of these signals
const std::atomic<bool>& stop_on_signals();

/// Like stop_on_signals, for commands that cannot stop midway: the first signal ends the process.
void end_on_signals();

/// Set by USR1; the reader clears it.
std::atomic<bool>& checkpoint_request();

}  // namespace orrery::cli
