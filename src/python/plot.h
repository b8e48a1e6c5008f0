// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

namespace orrery::python {

/// Adds the function `plot(data, words, threads, memory_limit, on_progress, on_warning)`, which renders particles as
/// `orrery plot` does and returns the picture and what was chosen from the data, a line each.
///
/// `data`     a file name, or a tuple of columns, see table_of(), and of the simulation box or None: its origin, edges
///            and which of them are periodic
/// `words`    options of the command line and their values
void bind_plot(pybind11::module_& m);

}  // namespace orrery::python
