// SPDX-License-Identifier: Apache-2.0
#include "film/film.h"

#include "film/layer_pixel.h"
#include "film/picture.h"
#include "math/pixels.h"

namespace orrery::film {

Film::Film(int width_px, int height_px)
    : width_(width_px), height_(height_px), sums_(math::pixel_count(width_px, height_px)) {}

kernel::PixelSum* Film::at(int x, int y) noexcept { return sums_.data() + static_cast<std::ptrdiff_t>(y) * width_ + x; }

void Film::add(const Film& other) {
  for (std::size_t i = 0; i < sums_.size(); ++i) sums_[i] += other.sums_[i];
}

Picture Film::picture(const Film* second) const {
  Picture out;
  out.width = width_;
  out.height = height_;
  const char* const names[3] = {"R", "G", "B"};
  for (int c = 0; c < 3; ++c) {
    Plane plane{names[c], std::vector<float>(sums_.size(), 0.0f)};
    for (std::size_t i = 0; i < sums_.size(); ++i) {
      kernel::PixelSum sum = sums_[i];
      if (second != nullptr) sum += second->sums_[i];
      plane.values[i] = static_cast<float>(mean(sum.rgb[c], sum.weight));
    }
    out.planes.push_back(std::move(plane));
  }
  out.planes.push_back({"A", std::vector<float>(sums_.size(), 1.0f)});
  return out;
}

}  // namespace orrery::film
