// SPDX-License-Identifier: Apache-2.0
#include "python/arrays.h"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "base/available_memory.h"
#include "base/error.h"
#include "base/text.h"
#include "data/data_file.h"
#include "points/rows.h"

namespace py = pybind11;

namespace orrery::python {
namespace {

struct ReadPoints {
  data::FrameInfo info;
  data::Table table;
  int frames = 1;
};

/// Reads columns of a frame, and the columns that derived ones are computed from.
///
/// `names`    empty: all
ReadPoints read(const std::filesystem::path& file, int frame, std::optional<int> component,
                const std::vector<std::string>& names, const std::filesystem::path& topology) {
  data::OpenOptions options;
  options.component = component;
  options.topology = topology;
  options.limit_memory(base::available_memory().value_or(0));
  const std::unique_ptr<data::DataFile> opened = data::open(file, options);
  ReadPoints out;
  out.frames = opened->frame_count();
  if (frame < 1 || frame > out.frames)
    base::refuse(fmt::format("there is no frame {}; {} has {}", frame, file.string(),
                             base::counted(static_cast<std::uint64_t>(out.frames), "frame")));
  out.info = opened->describe(frame - 1);
  points::add_derived_columns(out.info);
  std::vector<std::string> known, wanted, sources;
  for (const data::ColumnInfo& column : out.info.columns) {
    known.push_back(column.name);
    if (!names.empty() && !base::contains(names, column.name)) continue;
    if (column.is_derived) sources = points::sources_of(out.info, column.name);
    if (!column.is_derived) wanted.push_back(column.name);
  }
  for (const std::string& name : names)
    if (!base::contains(known, name))
      base::refuse(file.string() + " has no column `" + name + "`; its columns are " + base::joined(known));
  for (const std::string& source : sources)
    if (!base::contains(wanted, source)) wanted.push_back(source);
  out.table = opened->read(frame - 1, wanted);
  if (!sources.empty()) points::compute_speed(sources, out.table);
  std::erase_if(out.table.columns,
                [&](const data::Column& column) { return !names.empty() && !base::contains(names, column.name); });
  return out;
}

py::object text_or_none(const std::string& text) { return text.empty() ? py::none() : py::object(str_of(text)); }

py::dict described(const data::FrameInfo& info, int frames) {
  py::dict out;
  out["frames"] = frames;
  out["title"] = str_of(info.title);
  out["step"] = info.step;
  out["position"] = info.roles.position;
  out["radius"] = text_or_none(info.roles.radius);
  out["radius_scale"] = info.roles.radius_scale;
  out["box"] = py::none();
  if (info.box) {
    py::list edges;
    for (const math::Vec3d edge : info.box->edges) edges.append(list_of(edge));
    out["box"] = py::make_tuple(list_of(info.box->origin), edges, info.box->periodic);
  }
  return out;
}

py::tuple read_points(const std::filesystem::path& file, int frame, std::optional<int> component,
                      const std::vector<std::string>& names, const std::filesystem::path& topology) {
  ReadPoints points;
  {
    const py::gil_scoped_release released;
    points = read(file, frame, component, names, topology);
  }
  py::dict columns;
  for (data::Column& column : points.table.columns) columns[str_of(column.name)] = array_of(std::move(column.values));
  return py::make_tuple(columns, described(points.info, points.frames));
}

}  // namespace

void bind_read_points(py::module_& m) { m.def("read_points", &read_points); }

}  // namespace orrery::python
