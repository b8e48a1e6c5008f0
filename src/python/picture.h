// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/numpy.h>

#include <memory>
#include <string>
#include <vector>

#include "display/forward.h"
#include "film/forward.h"
#include "job/forward.h"

namespace orrery::python {

/// A rendered image. Its channels are kept interleaved by layer, as arrays show them.
class Picture {
 public:
  explicit Picture(job::Rendering rendering);
  Picture(Picture&&) noexcept;
  ~Picture();

  int width() const;
  int height() const;
  const job::JobReport& report() const;
  std::vector<std::string> layers() const;
  std::vector<std::string> channels(const std::string& layer) const;

  /// A layer as a read-only array without a copy: (height, width) for one channel, else (height, width, channels).
  ///
  /// `self`     the Python object of this picture, which the array keeps alive
  /// `layer`    empty: the beauty
  /// Result     None if there is no such layer
  static pybind11::object array(const pybind11::object& self, const std::string& layer);

  /// Writes image files.
  ///
  /// Errors     those of job::write_rendering
  void write(const job::Outputs& outputs) const;

  /// Returns the image as sRGB with 8 bits per channel.
  ///
  /// Errors     those of display::develop; base::Error(kUsage) if the display is not sRGB
  film::EncodedPicture srgb8(const display::Settings& display) const;

 private:
  struct Layer {
    std::string name;
    std::vector<std::size_t> planes;  ///< indices into the planes of the picture
    std::vector<float> values;        ///< interleaved
  };
  const Layer* find(const std::string& name) const;
  /// Returns the rendering with its planes, which are not stored otherwise.
  job::Rendering with_planes() const;

  std::unique_ptr<job::Rendering> rendering_;
  std::vector<Layer> layers_;
};

}  // namespace orrery::python
