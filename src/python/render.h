// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include "job/forward.h"

namespace orrery::python {

class Picture;

/// Renders on a separate thread, without the GIL, while the calling thread reports progress and warnings and checks for
/// signals: KeyboardInterrupt, and an exception in a callback, stop the render.
///
/// `on_progress`  called with fraction, samples done, samples in all, seconds and goal; or None
/// `on_warning`   called with a text
/// Domain         the calling thread holds the GIL; the job has no outputs and no hooks
/// Errors         those of job::run_job; those of the callbacks
Picture render(job::Job job, const pybind11::object& on_progress, const pybind11::object& on_warning);

/// Stops the renders of all other threads and waits until they have ended. Those threads are daemon threads and do not
/// return to Python. Called before the interpreter finalizes, which would otherwise kill them in the middle of a
/// render.
///
/// Domain     the calling thread holds the GIL
void stop_renders();

}  // namespace orrery::python
