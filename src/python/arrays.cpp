// SPDX-License-Identifier: Apache-2.0
#include "python/arrays.h"

#include <pybind11/stl.h>

#include <cstdint>
#include <type_traits>

#include "base/error.h"

namespace py = pybind11;

namespace orrery::python {
namespace {

template <class T>
std::vector<T> copied(const py::array& array) {
  const data::ArrayView<T> view(array.data(), array.strides(0), static_cast<std::size_t>(array.shape(0)));
  std::vector<T> out(view.size());
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = view[i];
  return out;
}

data::Values values_of(const py::array& array) {
  const auto size = static_cast<std::size_t>(array.shape(0));
  if (py::isinstance<py::array_t<double>>(array)) return data::ArrayView<double>(array.data(), array.strides(0), size);
  if (py::isinstance<py::array_t<float>>(array)) return data::ArrayView<float>(array.data(), array.strides(0), size);
  if (py::isinstance<py::array_t<std::int64_t>>(array)) return copied<std::int64_t>(array);
  if (py::isinstance<py::array_t<std::int32_t>>(array)) return copied<std::int32_t>(array);
  if (py::isinstance<py::array_t<std::uint16_t>>(array)) return copied<std::uint16_t>(array);
  if (py::isinstance<py::array_t<std::uint8_t>>(array)) return copied<std::uint8_t>(array);
  throw base::Error(base::ErrorKind::kInternal, "array of an unexpected type");
}

/// Moves a vector into an array, which owns it.
template <class T>
py::object moved(std::vector<T> values) {
  auto owned = std::make_unique<std::vector<T>>(std::move(values));
  const py::capsule owner(owned.get(), [](void* p) { delete static_cast<std::vector<T>*>(p); });
  const std::vector<T>& kept = *owned.release();
  return py::array_t<T>(static_cast<py::ssize_t>(kept.size()), kept.data(), owner);
}

}  // namespace

std::shared_ptr<const data::Table> table_of(const std::vector<NamedArray>& columns) {
  auto out = std::make_shared<data::Table>();
  for (const auto& [name, array, words] : columns) {
    out->rows = static_cast<std::size_t>(array.shape(0));
    if (words) {
      const std::vector<std::int32_t> index = copied<std::int32_t>(array);
      out->columns.push_back({name, data::Words{*words, {index.begin(), index.end()}}});
    } else {
      out->columns.push_back({name, values_of(array)});
    }
  }
  return out;
}

py::str str_of(const std::string& bytes) {
  PyObject* const text = PyUnicode_DecodeUTF8(bytes.data(), static_cast<Py_ssize_t>(bytes.size()), "replace");
  if (text == nullptr) throw py::error_already_set();
  return py::reinterpret_steal<py::str>(text);
}

py::list list_of(math::Vec3d v) {
  py::list out;
  for (const double x : {v.x, v.y, v.z}) out.append(x);
  return out;
}

py::object array_of(data::Values values) {
  return std::visit(
      [](auto& all) -> py::object {
        using Column = std::decay_t<decltype(all)>;
        if constexpr (std::is_same_v<Column, data::Words>) {
          py::list words;
          for (const std::string& word : all.words) words.append(str_of(word));
          py::list out(all.index.size());
          for (std::size_t i = 0; i < all.index.size(); ++i) out[i] = words[all.index[i]];
          return out;
        } else if constexpr (requires { all.push_back({}); }) {
          return moved(std::move(all));
        } else {
          throw base::Error(base::ErrorKind::kInternal, "files have no views");
        }
      },
      values);
}

void add_to_extent(const data::Table& positions, double radius, plot::ViewExtent& extent) {
  const auto add = [&](const auto& x) {
    // All three axes have the type of the array.
    using Numbers = std::decay_t<decltype(x)>;
    if constexpr (!std::is_same_v<Numbers, data::Words>) {
      const auto& y = std::get<Numbers>(positions.columns[1].values);
      const auto& z = std::get<Numbers>(positions.columns[2].values);
      for (std::size_t i = 0; i < positions.rows; ++i) {
        const math::Vec3d center{static_cast<double>(x[i]), static_cast<double>(y[i]), static_cast<double>(z[i])};
        if (!math::is_finite(center))
          throw base::Error(base::ErrorKind::kBadData,
                            "row " + std::to_string(i + 1) + " of positions is not finite; leave such rows out");
        extent.add(center, radius);
      }
    }
  };
  std::visit(add, positions.columns[0].values);
}

}  // namespace orrery::python
