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
/// Errors         those of make_job and job::render_in_memory; those of the callbacks
Picture render(const std::function<job::Job()>& make_job, const pybind11::object& on_progress,
               const pybind11::object& on_warning);

/// Stops the renders of all other threads and waits until they have ended. Those threads are daemon threads and do not
/// return to Python. Called before the interpreter finalizes, which would otherwise kill them in the middle of a
/// render.
///
/// Domain     the calling thread holds the GIL
void stop_renders();

/// Adds the function `plot(data, words, threads, memory_limit, on_progress, on_warning)`, which renders particles as
/// `orrery plot` does and returns the picture and what was chosen from the data, a line each; and
/// `movie(FilmFile(file, fps, turntable_s, keeps_frames), data, ...)`, which writes a film and returns its frames and
/// the choices.
///
/// `data`     a file name; a tuple of columns, see table_of(), and of the simulation box or None: its origin, edges
///            and which of them are periodic; or a tuple of a function that returns this for a frame, and the number
///            of frames
/// `words`    options of the command line and their values
void bind_plot(pybind11::module_& m);

/// Adds the class `ScenePage(scene, title, options, port, threads, memory_limit)`, a page in a browser that shows a
/// scene whose arrays outlive it.
///
/// `options`  first values of the controls, as in view::Wish
/// `port`     0: a free one
/// Errors     those of http::serve
void bind_view(pybind11::module_& m);

}  // namespace orrery::python
