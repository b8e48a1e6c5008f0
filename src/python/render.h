// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <functional>

#include "job/forward.h"

namespace orrery::python {

class Picture;

/// Runs jobs on a separate thread, without the GIL, while the calling thread reports progress and warnings and checks
/// for signals: KeyboardInterrupt, and an exception in a callback, stop the jobs.
///
/// `work`         called on that thread, in a base::StopScope, with the hooks for its jobs
/// `on_progress`  called with fraction, samples done, samples in all, seconds and goal; or None
/// `on_warning`   called with a text
/// Domain         the calling thread holds the GIL
/// Errors         those of `work` and of the callbacks
void run(const std::function<void(const job::Hooks&)>& work, const pybind11::object& on_progress,
         const pybind11::object& on_warning);

/// Renders an image by run().
///
/// `make_job`     called on that thread; the job has no outputs and no hooks
/// Errors         those of make_job and job::run_job; those of the callbacks
Picture render(const std::function<job::Job()>& make_job, const pybind11::object& on_progress,
               const pybind11::object& on_warning);

/// Stops the renders of all other threads and waits until they have ended. Those threads are daemon threads and do not
/// return to Python. Called before the interpreter finalizes, which would otherwise kill them in the middle of a
/// render.
///
/// Domain     the calling thread holds the GIL
void stop_renders();

}  // namespace orrery::python
