// SPDX-License-Identifier: Apache-2.0
#include "metrics/convolve.h"

#include <algorithm>
#include <cmath>

namespace orrery::metrics {

Taps taps_of(int radius, const std::function<double(double)>& shape) {
  double sum = 0;
  for (int x = -radius; x <= radius; ++x) sum += shape(x);
  Taps taps;
  for (int x = -radius; x <= radius; ++x) taps.push_back(static_cast<float>(shape(x) / sum));
  return taps;
}

Taps gaussian_taps(int radius, double sigma) {
  return taps_of(radius, [sigma](double x) { return std::exp(-x * x / (2 * sigma * sigma)); });
}

Map convolved(const Map& map, const Taps& along_x, const Taps& along_y) {
  const int w = map.width, h = map.height;
  const int rx = static_cast<int>(along_x.size()) / 2, ry = static_cast<int>(along_y.size()) / 2;
  const auto row = [w](auto& values, int y) { return values.data() + static_cast<std::ptrdiff_t>(y) * w; };
  Map between{w, h, std::vector<float>(map.values.size())}, out{w, h, std::vector<float>(map.values.size())};
  std::vector<float> padded(static_cast<std::size_t>(w + 2 * rx));
  for (int y = 0; y < h; ++y) {
    const float* const from = row(map.values, y);
    for (int x = -rx; x < w + rx; ++x) padded[static_cast<std::size_t>(x + rx)] = from[std::clamp(x, 0, w - 1)];
    float* const to = row(between.values, y);
    // One tap over a whole row at a time, which the compiler vectorizes.
    for (std::size_t k = 0; k < along_x.size(); ++k)
      for (int x = 0; x < w; ++x) to[x] += along_x[k] * padded[static_cast<std::size_t>(x) + k];
  }
  for (int y = 0; y < h; ++y) {
    float* const to = row(out.values, y);
    for (int k = -ry; k <= ry; ++k) {
      const float* const from = row(between.values, std::clamp(y + k, 0, h - 1));
      const float tap = along_y[static_cast<std::size_t>(k + ry)];
      for (int x = 0; x < w; ++x) to[x] += tap * from[x];
    }
  }
  return out;
}

}  // namespace orrery::metrics
