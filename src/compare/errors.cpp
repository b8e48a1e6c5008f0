// SPDX-License-Identifier: Apache-2.0
#include "compare/errors.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "film/display_error.h"
#include "math/pixels.h"

namespace orrery::compare {
namespace {

/// Relative difference that storing one of the images in half precision can cause.
constexpr double kHalfPrecision = 0x1p-10;

}  // namespace

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

double two_sided_quantile(double chance) {
  double low = 0, high = 40;
  for (int i = 0; i < 80; ++i) {
    const double z = (low + high) / 2;
    (std::erfc(z / std::numbers::sqrt2) > chance ? low : high) = z;
  }
  return high;
}

std::optional<ZTest> z_test(const ColorView& picture, const ColorView& variance, const ColorView& reference,
                            const ColorView& reference_variance) {
  if (variance.channel[0] == nullptr) return {};
  ZTest out;
  std::vector<double> zs;
  double squares = 0, variances = 0, differences = 0, light = 0;
  for (int c = 0; c < 3; ++c) {
    for (int y0 = 0; y0 < picture.height; y0 += kTestedSide) {
      for (int x0 = 0; x0 < picture.width; x0 += kTestedSide) {
        double sum = 0, expected = 0, magnitude = 0, light_of_picture = 0;
        bool is_above = true, is_below = true;  // in every pixel
        for (int y = y0; y < std::min(y0 + kTestedSide, picture.height); ++y) {
          for (int x = x0; x < std::min(x0 + kTestedSide, picture.width); ++x) {
            const std::size_t i = math::pixel_index(x, y, picture.width);
            const double b = static_cast<double>(reference.channel[c][i]);
            const double d = static_cast<double>(picture.channel[c][i]) - b;
            double v = static_cast<double>(variance.channel[c][i]);
            if (reference_variance.channel[c] != nullptr) v += static_cast<double>(reference_variance.channel[c][i]);
            if (!std::isfinite(d) || !std::isfinite(v)) continue;
            sum += d;
            expected += v;
            squares += d * d;
            light += b;
            magnitude += std::abs(b);
            light_of_picture += std::abs(b + d);
            is_above = is_above && d > 0;
            is_below = is_below && d < 0;
          }
        }
        differences += sum;
        variances += expected;
        // Without variance, a difference of all pixels in the same direction is certain. Other differences may be due
        // to pixels whose variance is unknown: pixels with one sample, or where no path has found light yet.
        const bool is_certain =
            (is_above || is_below) && light_of_picture > 0 && std::abs(sum) > kHalfPrecision * magnitude;
        if (!(expected > 0) && !is_certain) continue;
        const double z = expected > 0 ? sum / std::sqrt(expected) : std::copysign(kCertainZ, sum);
        zs.push_back(z);
        if (std::abs(z) <= std::abs(out.largest_z)) continue;
        out.largest_z = z;
        out.channel = c;
        out.x = x0;
        out.y = y0;
      }
    }
  }
  out.tests = static_cast<int>(zs.size());
  out.critical_z = two_sided_quantile(kFamilyWiseError / std::max(out.tests, 1));
  out.rejected =
      static_cast<int>(std::count_if(zs.begin(), zs.end(), [&](double z) { return std::abs(z) > out.critical_z; }));
  const double n = 3 * static_cast<double>(picture.pixels());
  out.noise = std::sqrt(variances / n);
  out.bias = std::sqrt(std::max(0.0, (squares - variances) / n));
  if (light != 0) {
    out.mean_bias = differences / light;
    out.mean_bias_error = std::sqrt(variances) / std::abs(light);
  }
  return out;
}

}  // namespace orrery::compare
