// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

namespace orrery::python {

/// Adds the function `read_points(file, frame, component, columns)`, which returns the columns of a data file as
/// arrays, and their metadata.
void bind_read_points(pybind11::module_& m);

}  // namespace orrery::python
