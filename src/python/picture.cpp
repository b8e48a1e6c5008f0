// SPDX-License-Identifier: Apache-2.0
#include "python/picture.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>

#include "base/error.h"
#include "display/develop.h"
#include "python/arrays.h"

namespace py = pybind11;

namespace orrery::python {
namespace {

display::Settings display_settings(const std::string& display, const std::string& view, const std::string& look,
                                   std::optional<double> exposure) {
  display::Settings out;
  out.display = display;
  out.view = view;
  out.look = look;
  out.exposure = exposure;
  return out;
}

[[noreturn]] void refuse_pickling(const Picture&) {
  throw py::type_error(
      "a Picture cannot be pickled; pass arrays to other processes, e.g. picture.beauty, or files: "
      "picture.write(file)");
}

}  // namespace

Picture::Picture(job::Rendering rendering) : rendering_(std::move(rendering)) {
  std::vector<film::Plane>& planes = rendering_.picture.planes;
  for (std::size_t p = 0; p < planes.size(); ++p) {
    // Z is a separate layer, although its channel has no layer name in an EXR.
    const bool is_beauty = planes[p].name.size() == 1 && std::string("RGBA").find(planes[p].name) != std::string::npos;
    const std::string name = is_beauty ? "" : planes[p].layer().empty() ? planes[p].name : planes[p].layer();
    auto layer = std::find_if(layers_.begin(), layers_.end(), [&](const Layer& l) { return l.name == name; });
    if (layer == layers_.end()) layer = layers_.insert(layers_.end(), {name, {}, {}});
    layer->planes.push_back(p);
  }
  for (Layer& layer : layers_) {
    const std::size_t channels = layer.planes.size();
    if (channels == 1) {
      layer.values = std::exchange(planes[layer.planes[0]].values, {});
      continue;
    }
    layer.values.resize(channels * planes[layer.planes[0]].values.size());
    for (std::size_t c = 0; c < channels; ++c) {
      const std::vector<float> plane = std::exchange(planes[layer.planes[c]].values, {});
      for (std::size_t i = 0; i < plane.size(); ++i) layer.values[i * channels + c] = plane[i];
    }
  }
}

const Picture::Layer* Picture::find(const std::string& name) const {
  for (const Layer& layer : layers_)
    if (layer.name == name) return &layer;
  return nullptr;
}

std::vector<std::string> Picture::layers() const {
  std::vector<std::string> out;
  for (const Layer& layer : layers_)
    if (!layer.name.empty()) out.push_back(layer.name);
  return out;
}

std::vector<std::string> Picture::channels(const std::string& layer) const {
  std::vector<std::string> out;
  if (const Layer* found = find(layer))
    for (const std::size_t p : found->planes) {
      const std::string& name = rendering_.picture.planes[p].name;
      const std::size_t dot = name.rfind('.');
      out.push_back(dot == std::string::npos ? name : name.substr(dot + 1));
    }
  return out;
}

py::object Picture::array(const py::object& self, const std::string& layer) {
  const auto& picture = self.cast<const Picture&>();
  const Layer* const found = picture.find(layer);
  if (found == nullptr) return py::none();
  std::vector<py::ssize_t> shape = {picture.height(), picture.width()};
  if (found->planes.size() > 1) shape.push_back(static_cast<py::ssize_t>(found->planes.size()));
  return view_of(found->values.data(), std::move(shape), self);
}

job::Rendering Picture::with_planes() const {
  job::Rendering out = rendering_;
  for (const Layer& layer : layers_) {
    const std::size_t channels = layer.planes.size();
    for (std::size_t c = 0; c < channels; ++c) {
      std::vector<float>& plane = out.picture.planes[layer.planes[c]].values;
      plane.resize(layer.values.size() / channels);
      for (std::size_t i = 0; i < plane.size(); ++i) plane[i] = layer.values[i * channels + c];
    }
  }
  return out;
}

py::dict Picture::statistics() const {
  const job::JobReport& report = rendering_.report;
  py::dict out;
  out["spheres"] = report.spheres;
  out["rods"] = report.rods;
  out["paths"] = report.render.paths;
  out["rays"] = report.render.rays;
  out["fewest_samples"] = report.render.min_samples;
  out["most_samples"] = report.render.max_samples;
  out["threads"] = report.render.threads;
  out["noise"] = report.render.noise;
  out["read_seconds"] = report.phases.read_s;
  out["compile_seconds"] = report.phases.compile_s;
  out["build_seconds"] = report.phases.build_s;
  out["render_seconds"] = report.phases.render_s;
  out["denoise_seconds"] = report.phases.denoise_s;
  return out;
}

void Picture::write(const std::vector<std::filesystem::path>& files, int bits, const display::Settings& display,
                    bool as_float, const std::string& compression, bool multipart, bool reproducible) const {
  job::Outputs outputs;
  outputs.images.assign(files.begin(), files.end());
  outputs.display = display;
  outputs.bits = bits;
  outputs.exr.as_float = as_float;
  if (!compression.empty()) outputs.exr.compression = compression;
  outputs.exr.multipart = multipart;
  outputs.reproducible = reproducible;
  job::write_rendering(with_planes(), outputs);
}

py::array Picture::srgb8(const display::Settings& display) const {
  film::EncodedPicture encoded;
  {
    const py::gil_scoped_release released;
    const auto alpha = rendering_.picture.is_transparent ? display::Alpha::kStraight : display::Alpha::kOverBlack;
    encoded = display::develop(with_planes().picture, job::display_of(rendering_, display), 8, alpha);
  }
  if (!encoded.is_srgb) base::refuse("the scene's display is not sRGB; set display=\"sRGB\"");
  py::array_t<std::uint8_t> out({encoded.height, encoded.width, encoded.channels});
  std::copy(encoded.values.begin(), encoded.values.end(), out.mutable_data());
  return out;
}

void bind_picture(py::module_& m) {
  py::class_<display::Settings>(m, "Display").def(py::init(&display_settings));
  py::class_<Picture>(m, "Picture")
      .def_property_readonly("width", &Picture::width)
      .def_property_readonly("height", &Picture::height)
      .def_property_readonly("layers", &Picture::layers)
      .def("channels", &Picture::channels)
      .def("statistics", &Picture::statistics)
      .def("array", &Picture::array)
      .def("srgb8", &Picture::srgb8)
      .def("__reduce__", &refuse_pickling)
      .def("write", &Picture::write, py::call_guard<py::gil_scoped_release>());
}

}  // namespace orrery::python
