// SPDX-License-Identifier: Apache-2.0
#include "metrics/ssim.h"

#include "metrics/convolve.h"

namespace orrery::metrics {
namespace {

Map luma(const ColorView& v) {
  Map out{v.width, v.height, std::vector<float>(v.pixels())};
  for (std::size_t i = 0; i < out.values.size(); ++i)
    out.values[i] = 0.299f * v.channel[0][i] + 0.587f * v.channel[1][i] + 0.114f * v.channel[2][i];
  return out;
}

Map product(const Map& a, const Map& b) {
  Map out = a;
  for (std::size_t i = 0; i < out.values.size(); ++i) out.values[i] *= b.values[i];
  return out;
}

}  // namespace

double ssim(const ColorView& picture, const ColorView& reference) {
  constexpr double kC1 = 0.01 * 0.01, kC2 = 0.03 * 0.03;
  const Taps taps = gaussian_taps(5, 1.5);
  const auto mean = [&](const Map& m) { return convolved(m, taps, taps); };
  const Map a = luma(picture), b = luma(reference);
  const Map mean_a = mean(a), mean_b = mean(b), aa = mean(product(a, a)), bb = mean(product(b, b)),
            ab = mean(product(a, b));
  double sum = 0;
  for (std::size_t i = 0; i < a.values.size(); ++i) {
    const double x = static_cast<double>(mean_a.values[i]), y = static_cast<double>(mean_b.values[i]);
    const double var_a = static_cast<double>(aa.values[i]) - x * x, var_b = static_cast<double>(bb.values[i]) - y * y;
    const double covariance = static_cast<double>(ab.values[i]) - x * y;
    sum += (2 * x * y + kC1) * (2 * covariance + kC2) / ((x * x + y * y + kC1) * (var_a + var_b + kC2));
  }
  return sum / static_cast<double>(a.values.size());
}

}  // namespace orrery::metrics
