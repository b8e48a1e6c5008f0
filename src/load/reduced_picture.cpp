// SPDX-License-Identifier: Apache-2.0
#include "load/reduced_picture.h"

#include <algorithm>
#include <cmath>

#include "format/read_result.h"

namespace orrery::load {

void reduce_picture(format::ReadResult& scene, double pixels) {
  scene::Image& image = scene.scene.image;
  const double scale = std::min(1.0, std::sqrt(pixels / (static_cast<double>(image.width) * image.height)));
  image.crop.reset();
  image.overscan = 0;
  image.width = std::max(1, static_cast<int>(std::lround(image.width * scale)));
  image.height = std::max(1, static_cast<int>(std::lround(image.height * scale)));
  if (scene.closing) scene.closing->image = image;
}

}  // namespace orrery::load
