// SPDX-License-Identifier: Apache-2.0
#include "film/partial.h"

namespace orrery::film {

RenderWork& RenderWork::operator+=(const RenderWork& other) {
  paths += other.paths;
  rays += other.rays;
  bad_samples += other.bad_samples;
  seconds += other.seconds;
  return *this;
}

void Partial::mean(int x, int y, float* rgb) const {
  const std::size_t i =
      static_cast<std::size_t>(y) * static_cast<std::size_t>(film.width()) + static_cast<std::size_t>(x);
  const auto convert = [rgb](const kernel::PixelSum& sum) {
    for (int c = 0; c < 3; ++c)
      rgb[c] = sum.weight > 0
                   ? static_cast<float>(kernel::from_fixed_point(sum.rgb[c]) / static_cast<double>(sum.weight))
                   : 0.0f;
  };
  if (!has_halves()) return convert(film.sums()[i]);
  kernel::PixelSum sum = film.sums()[i];
  convert(sum += second.sums()[i]);
}

}  // namespace orrery::film
