// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>

namespace orrery::cli {

/// From now on INT, TERM and HUP ask whoever looks at the result to stop; a second one ends the process at once with
/// 128 + its number, without a torn or temporary file.
///
/// Signals that the process was started with ignored, as nohup does with HUP, stay so.
///
/// Result     true once a signal has come
const std::atomic<bool>& stop_on_signals();

/// The same for what cannot be asked to stop: the first signal ends the process.
void end_on_signals();

/// From now on USR1 sets what this returns; whoever looks at it sets it to false again.
std::atomic<bool>& snapshot_on_signal();

}  // namespace orrery::cli
