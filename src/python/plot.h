// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

namespace orrery::python {

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

}  // namespace orrery::python
