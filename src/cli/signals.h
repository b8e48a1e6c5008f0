// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>

namespace orrery::cli {

/// The first thing that a run does. From then on a pipe that nobody reads any more and a limit on the size of files are
/// failed writes, not the end of the process; USR1 asks for a snapshot. All commands take USR1, since a supervisor
/// sends it to whatever is running. What a parent has blocked is unblocked.
///
/// Signals that the process was started with ignored stay so.
void prepare_signals();

/// From now on INT, TERM and HUP ask whoever looks at the result to stop; a second one ends the process at once with
/// 128 + its number, without a torn or temporary file.
///
/// Signals that the process was started with ignored, as nohup does with HUP, stay so.
///
/// Result     true once a signal has come
const std::atomic<bool>& stop_on_signals();

/// The same for what cannot be asked to stop: the first signal ends the process.
void end_on_signals();

/// True once USR1 has come; whoever looks at it sets it to false again.
std::atomic<bool>& snapshot_request();

}  // namespace orrery::cli
