// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/numpy.h>

#include <filesystem>
#include <string>
#include <vector>

#include "display/settings.h"
#include "job/rendering.h"

namespace orrery::python {

/// A rendered image. Its channels are kept interleaved by layer, as arrays show them.
class Picture {
 public:
  explicit Picture(job::Rendering rendering);

  int width() const { return rendering_.picture.width; }
  int height() const { return rendering_.picture.height; }
  std::vector<std::string> layers() const;
  std::vector<std::string> channels(const std::string& layer) const;
  pybind11::dict statistics() const;

  /// A layer as a read-only array without a copy: (height, width) for one channel, else (height, width, channels).
  ///
  /// `self`     the Python object of this picture, which the array keeps alive
  /// `layer`    empty: the beauty
  /// Result     None if there is no such layer
  static pybind11::object array(const pybind11::object& self, const std::string& layer);

  /// Writes image files.
  ///
  /// `compression`  of EXR; empty: the default
  /// Errors         those of job::write_rendering
  void write(const std::vector<std::filesystem::path>& files, int bits, const display::Settings& display, bool as_float,
             const std::string& compression, bool multipart, bool reproducible) const;

  /// Returns the image as sRGB with 8 bits per channel: (height, width, channels).
  ///
  /// Errors     those of display::develop; base::Error(kUsage) if the display is not sRGB
  pybind11::array srgb8(const display::Settings& display) const;

 private:
  struct Layer {
    std::string name;
    std::vector<std::size_t> planes;  ///< indices into the planes of the picture
    std::vector<float> values;        ///< interleaved
  };
  const Layer* find(const std::string& name) const;
  /// Returns the rendering with its planes, which are not stored otherwise.
  job::Rendering with_planes() const;

  job::Rendering rendering_;
  std::vector<Layer> layers_;
};

/// Adds the class `Picture`, and `Display`, the settings of a display transform.
void bind_picture(pybind11::module_& m);

}  // namespace orrery::python
