// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>

namespace orrery::cli {

/// From now on INT and TERM ask the render to stop; a second one ends the process at once, without a torn or temporary
/// file.
///
/// Result     true once a signal has come
const std::atomic<bool>& stop_on_signals();

}  // namespace orrery::cli
