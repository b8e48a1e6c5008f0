// SPDX-License-Identifier: Apache-2.0
#include "metrics/pixel_errors.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "film/display_error.h"

namespace orrery::metrics {

double PixelErrors::psnr_db() const {
  return rmse > 0 ? -20 * std::log10(rmse) : std::numeric_limits<double>::infinity();
}

PixelErrors pixel_errors(const ColorView& picture, const ColorView& reference, const std::vector<bool>& excluded) {
  PixelErrors out;
  double squares = 0, absolute = 0, relative = 0, signed_sum = 0, light = 0;
  for (int c = 0; c < 3; ++c) {
    for (std::size_t i = 0; i < picture.pixels(); ++i) {
      if (!excluded.empty() && excluded[i]) continue;
      const double a = static_cast<double>(picture.channel[c][i]), b = static_cast<double>(reference.channel[c][i]);
      if (!std::isfinite(a) || !std::isfinite(b)) {
        ++out.not_finite;
        continue;
      }
      const double difference = a - b;
      squares += difference * difference;
      absolute += std::abs(difference);
      relative += difference * difference / (b * b + kRelativeFloor);
      signed_sum += difference;
      light += b;
      ++out.values;
      if (std::abs(difference) <= out.max) continue;
      out.max = std::abs(difference);
      out.max_channel = c;
      out.max_x = static_cast<int>(i % static_cast<std::size_t>(picture.width));
      out.max_y = static_cast<int>(i / static_cast<std::size_t>(picture.width));
    }
  }
  if (out.values == 0) return out;
  const auto n = static_cast<double>(out.values);
  out.rmse = std::sqrt(squares / n);
  out.mae = absolute / n;
  out.relative_mse = relative / n;
  out.bias = light != 0 ? signed_sum / light : 0;
  double display = 0;
  for (const float e : display_error_map(picture, reference, excluded).values)
    display += static_cast<double>(e) * static_cast<double>(e);
  const auto pixels =
      static_cast<std::ptrdiff_t>(picture.pixels()) - std::count(excluded.begin(), excluded.end(), true);
  out.display = std::sqrt(display / static_cast<double>(pixels));
  return out;
}

Map display_error_map(const ColorView& picture, const ColorView& reference, const std::vector<bool>& excluded) {
  Map out{picture.width, picture.height, std::vector<float>(picture.pixels())};
  for (std::size_t i = 0; i < out.values.size(); ++i) {
    if (!excluded.empty() && excluded[i]) continue;
    double squares = 0, light = 0;
    for (int c = 0; c < 3; ++c) {
      const double a = static_cast<double>(picture.channel[c][i]), b = static_cast<double>(reference.channel[c][i]);
      squares += (a - b) * (a - b);
      light += b;
    }
    const double e = std::sqrt(film::display_error_squared(squares, light));
    if (std::isfinite(e)) out.values[i] = static_cast<float>(e);
  }
  return out;
}

}  // namespace orrery::metrics
