// SPDX-License-Identifier: Apache-2.0
#include "python/plot.h"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "cli/subject.h"
#include "data/table_file.h"
#include "formats/open.h"
#include "job/job.h"
#include "python/arrays.h"
#include "python/picture.h"
#include "python/render.h"

namespace py = pybind11;

namespace orrery::python {
namespace {

using Triple = std::array<double, 3>;
using BoxTuple = std::tuple<Triple, std::array<Triple, 3>, std::array<bool, 3>>;
using Arrays = std::tuple<std::vector<NamedArray>, std::optional<BoxTuple>>;

/// The name of arrays in a scene, which has no folder.
constexpr const char* kArraysName = "positions";

math::Vec3d vector_of(const Triple& v) { return {v[0], v[1], v[2]}; }

data::Box box_of(const BoxTuple& from) {
  const auto& [origin, edges, periodic] = from;
  return {vector_of(origin), {vector_of(edges[0]), vector_of(edges[1]), vector_of(edges[2])}, periodic};
}

py::tuple plot(const std::variant<Arrays, std::filesystem::path>& data, const std::vector<std::string>& words,
               int threads, std::uint64_t memory_limit, const py::object& on_progress, const py::object& on_warning) {
  std::string file = kArraysName;
  points::OpenData open;
  if (const auto* const arrays = std::get_if<Arrays>(&data)) {
    const auto& [columns, given] = *arrays;
    open = [table = table_of(columns), box = given ? std::optional(box_of(*given)) : std::nullopt](
               const std::filesystem::path& path, const data::OpenOptions& options) {
      return path == kArraysName ? data::open_table(path, table, box) : formats::open(path, options);
    };
  } else {
    file = std::get<std::filesystem::path>(data).string();
  }
  job::Resources resources;
  resources.threads = threads;
  resources.memory_limit = memory_limit;
  std::vector<std::string> notes;
  const auto make_job = [&] {
    view::Subject subject = cli::data_subject(file, words, resources, open);
    notes = std::move(subject.notes);
    return std::move(subject.job);
  };
  Picture picture = render(make_job, on_progress, on_warning);
  py::list choices;
  for (const std::string& note : notes) choices.append(str_of(note));
  return py::make_tuple(std::move(picture), choices);
}

}  // namespace

void bind_plot(py::module_& m) { m.def("plot", &plot); }

}  // namespace orrery::python
