// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/numpy.h>

#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "data/table.h"
#include "plot/view.h"

namespace orrery::python {

/// A column of a table: its name and a one-dimensional array; of strings, the array of their indices in the distinct
/// ones.
using NamedArray = std::tuple<std::string, pybind11::array, std::optional<std::vector<std::string>>>;

/// Makes a table of arrays. Arrays of float64 and float32 are not copied, regardless of their strides; the caller keeps
/// them alive.
///
/// Domain     one-dimensional arrays of one length, of native float64, float32, int64, int32, uint16 or uint8; indices
///            are int32
std::shared_ptr<const data::Table> table_of(const std::vector<NamedArray>& columns);

/// Returns a str. Bytes that are not valid UTF-8, as in older files and folders, are replaced.
pybind11::str str_of(const std::string& bytes);

/// Returns a list of three numbers.
pybind11::list list_of(math::Vec3d v);

/// Moves a column into a one-dimensional array without copying the numbers; strings become a list of str.
pybind11::object array_of(data::Values values);

/// Returns a read-only array that views values without a copy.
///
/// Domain     `owner` keeps the values alive
template <class T>
pybind11::array_t<T> view_of(const T* values, std::vector<pybind11::ssize_t> shape, const pybind11::object& owner) {
  pybind11::array_t<T> out(std::move(shape), values, owner);
  out.attr("setflags")(pybind11::arg("write") = false);
  return out;
}

/// Adds the spheres around some points to the extent of a view.
///
/// Domain     three columns of numbers
/// Errors     base::Error(kBadData) if one of them is not finite
void add_to_extent(const data::Table& positions, double radius, plot::ViewExtent& extent);

/// Adds the function `read_points(file, frame, component, columns, topology)`, which returns the columns of a data file
/// as arrays, and their metadata.
void bind_read_points(pybind11::module_& m);

}  // namespace orrery::python
