// SPDX-License-Identifier: Apache-2.0
#include "python/picture.h"

#include <algorithm>
#include <utility>

#include "base/error.h"
#include "display/develop.h"
#include "display/settings.h"
#include "film/picture.h"
#include "job/job.h"
#include "job/outputs.h"
#include "job/rendering.h"
#include "python/arrays.h"

namespace py = pybind11;

namespace orrery::python {

Picture::Picture(job::Rendering rendering) : rendering_(std::make_unique<job::Rendering>(std::move(rendering))) {
  std::vector<film::Plane>& planes = rendering_->picture.planes;
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

Picture::Picture(Picture&&) noexcept = default;
Picture::~Picture() = default;

int Picture::width() const { return rendering_->picture.width; }
int Picture::height() const { return rendering_->picture.height; }
const job::JobReport& Picture::report() const { return rendering_->report; }

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
      const std::string& name = rendering_->picture.planes[p].name;
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
  job::Rendering out = *rendering_;
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

void Picture::write(const job::Outputs& outputs) const { job::write_rendering(with_planes(), outputs); }

film::EncodedPicture Picture::srgb8(const display::Settings& display) const {
  const bool keeps_alpha = rendering_->picture.is_transparent;
  film::EncodedPicture out = display::develop(with_planes().picture, job::display_of(*rendering_, display), 8,
                                              keeps_alpha ? display::Alpha::kStraight : display::Alpha::kOverBlack);
  if (!out.is_srgb) base::refuse("the scene's display is not sRGB; set display=\"sRGB\"");
  return out;
}

}  // namespace orrery::python
