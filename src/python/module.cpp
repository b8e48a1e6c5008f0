// SPDX-License-Identifier: Apache-2.0
// The extension module orrery._orrery, on which the package orrery is built. Names and docstrings for users are there.
#include <dlfcn.h>

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <exception>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/module.h"
#include "base/text.h"
#include "job/job.h"
#include "job/prepared_scene.h"
#include "job/version.h"
#include "plot/view.h"
#include "points/color_map.h"
#include "python/arrays.h"
#include "python/picture.h"
#include "python/render.h"
#include "python/scene_data.h"
#include "scene/scene.h"

namespace py = pybind11;

namespace orrery::python {
namespace {

using ReleaseGil = py::call_guard<py::gil_scoped_release>;

/// The modules of other rooms use this module's `base` and `film`, as they use the program's (docs/decisions/0021).
void export_symbols() {
  Dl_info own{};
  if (dladdr(reinterpret_cast<const void*>(&export_symbols), &own) == 0 || own.dli_fname == nullptr ||
      dlopen(own.dli_fname, RTLD_NOW | RTLD_NOLOAD | RTLD_GLOBAL) == nullptr)
    throw base::Error(base::ErrorKind::kInternal, "cannot export the symbols of orrery's Python module");
  const std::filesystem::path package = std::filesystem::path(own.dli_fname).parent_path();
  // In a wheel, the modules are inside the package.
  for (const char* const folder : {"libexec/orrery", ORRERY_INSTALLED_MODULES, ORRERY_BUILT_MODULES}) {
    std::filesystem::path modules = (package / folder).lexically_normal();
    if (std::filesystem::exists(modules)) return base::set_module_folder(std::move(modules));
  }
}

/// The text that the program prints for an error, with the names of arguments for those of options.
std::string text_of(const base::Error& error) {
  std::string out;
  for (const base::Diagnostic& diagnostic : error.diagnostics()) out += base::formatted(diagnostic);
  return base::replaced(out + error.what(), "--memory-limit", "memory_limit");
}

const char* class_of(base::ErrorKind kind) {
  switch (kind) {
    case base::ErrorKind::kNoMemory: return "OutOfMemoryError";
    case base::ErrorKind::kUsage: return "UsageError";
    case base::ErrorKind::kBadData: return "SceneError";
    case base::ErrorKind::kMissingInput: return "MissingInputError";
    case base::ErrorKind::kCannotCreate:
    case base::ErrorKind::kIo: return "OutputError";
    case base::ErrorKind::kInternal:
    case base::ErrorKind::kStopped: break;
  }
  return "Error";
}

/// Sets errno, strerror and filename of an OSError.
void set_reason(const base::Error& error, const py::object& raised) {
  const auto* const failed = dynamic_cast<const base::FileError*>(&error);
  const int number = failed != nullptr                                ? failed->number()
                     : error.kind() == base::ErrorKind::kMissingInput ? ENOENT
                                                                      : EIO;
  raised.attr("errno") = number;
  raised.attr("strerror") = str_of(std::strerror(number));
  if (failed != nullptr)
    raised.attr("filename") = py::reinterpret_steal<py::str>(PyUnicode_DecodeFSDefault(failed->file().c_str()));
}

void translate(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const base::Error& error) {
    const py::object type = py::module_::import("orrery._errors").attr(class_of(error.kind()));
    const py::object raised = type(str_of(text_of(error)));
    raised.attr("exit_status") = base::exit_status(error.kind());
    if (PyErr_GivenExceptionMatches(type.ptr(), PyExc_OSError) != 0) set_reason(error, raised);
    PyErr_SetObject(type.ptr(), raised.ptr());
  }
}

/// What the renders of a scene share. A copy of the scene begins with nothing.
struct Prepared {
  std::shared_ptr<job::PreparedScene> scene = std::make_shared<job::PreparedScene>();
  /// During a render. Another one that runs at the same time, also from its on_progress, prepares its own scene.
  std::atomic<bool> is_in_use{false};
};

Picture render_scene(const SceneData& scene, Prepared& prepared, double noise, double seconds, int threads,
                     std::uint64_t memory_limit, bool denoise, const py::object& on_progress,
                     const py::object& on_warning) {
  job::Job job;
  job.scene = scene.source();
  job.settings.noise = noise;
  job.settings.time_budget_s = seconds;
  job.resources = {threads, memory_limit};
  job.denoise = denoise;
  const auto make_job = [&job] { return std::move(job); };
  if (prepared.is_in_use.exchange(true)) return render(make_job, on_progress, on_warning);
  struct Release {
    std::atomic<bool>& is_in_use;
    ~Release() { is_in_use = false; }
  } const release{prepared.is_in_use};
  job.prepared = prepared.scene;
  return render(make_job, on_progress, on_warning);
}

/// The camera that sees spheres of a larger radius around an extent, as keys of [camera]: a perspective camera if there
/// is a field of view, else an orthographic one.
py::dict camera_of(const plot::ViewExtent& extent, double aspect, double radius, std::optional<double> vfov_deg) {
  const scene::Camera camera = extent.grown(radius).camera(aspect, vfov_deg);
  py::dict out;
  if (vfov_deg) {
    out["vfov"] = *vfov_deg;
  } else {
    out["projection"] = "orthographic";
    out["width"] = camera.width.value_or(1);
  }
  out["look_from"] = list_of(camera.look_from);
  out["look_at"] = list_of(camera.look_at);
  out["up"] = list_of(camera.up);
  return out;
}

plot::ViewExtent extent_of(const std::vector<NamedArray>& positions, double radius, const std::string& look_from,
                           const std::string& up) {
  plot::ViewExtent extent(plot::view_axes(look_from, up));
  const std::shared_ptr<const data::Table> table = table_of(positions);
  const py::gil_scoped_release released;
  add_to_extent(*table, radius, extent);
  return extent;
}

void bind_scene(py::module_& m) {
  py::class_<Prepared>(m, "Prepared")
      .def(py::init<>())
      .def(py::pickle([](const Prepared&) { return py::tuple(); },
                      [](const py::tuple&) { return std::make_unique<Prepared>(); }));
  py::class_<SceneData>(m, "SceneData")
      .def(py::init([](std::filesystem::path file, bool is_file, std::string text, int typed_lines,
                       std::vector<std::string> overrides, int frame) {
        return SceneData{std::move(file), is_file, std::move(text), typed_lines, std::move(overrides), frame, {}};
      }))
      .def("add_table", [](SceneData& self, const std::string& name,
                           const std::vector<NamedArray>& columns) { self.tables[name] = table_of(columns); })
      .def(
          "check",
          [](const SceneData& self) {
            std::vector<std::string> out;
            for (const base::Diagnostic& warning : check(self)) out.push_back(base::formatted(warning));
            return out;
          },
          ReleaseGil())
      .def("check_keys", &check_keys)  // with the GIL: it takes microseconds
      .def("save", &save, ReleaseGil())
      .def("aspect", &aspect, ReleaseGil())
      .def("largest_radius", &largest_radius, ReleaseGil())
      .def("render", &render_scene);
  // Pickled as its bytes, for processes on the same machine.
  static_assert(std::is_trivially_copyable_v<plot::ViewExtent>);
  const auto bytes_of = [](const plot::ViewExtent& extent) {
    return py::bytes(reinterpret_cast<const char*>(&extent), sizeof extent);
  };
  const auto of_bytes = [](const py::bytes& state) {
    const std::string_view view = state;
    plot::ViewExtent extent(plot::view_axes("iso", "z"));
    if (view.size() != sizeof extent) throw py::value_error("not a pickled Extent of this version");
    std::memcpy(&extent, view.data(), sizeof extent);
    return extent;
  };
  py::class_<plot::ViewExtent>(m, "Extent")
      .def(py::init(&extent_of))
      .def("camera", &camera_of)
      .def(py::pickle(bytes_of, of_bytes));
}

}  // namespace

PYBIND11_MODULE(_orrery, m) {
  py::register_exception_translator(&translate);
  export_symbols();
  py::module_::import("atexit").attr("register")(py::cpp_function(&stop_renders));
  bind_scene(m);
  bind_picture(m);
  bind_view(m);
  bind_read_points(m);
  bind_plot(m);
  m.def("read_scene_text", &read_scene_text, ReleaseGil());
  m.def("color_map_names", &points::color_map_names);
  m.def("version", &job::program_version);
}

}  // namespace orrery::python
