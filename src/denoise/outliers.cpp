// SPDX-License-Identifier: Apache-2.0
#include "denoise/outliers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace orrery::denoise {
namespace {

/// Noise thresholds of outliers, as multiples of the mean light and of the mean noise of the window. A pixel that is
/// averaged over its neighbours changes them by 1 / 61 of its light: by at most 1 / 30 of the window's light if
/// there is little noise, and by less than the rest of the noise if there is much.
constexpr float kOfLight = 2, kOfNoise = 12;
/// The same as a multiple of the pixel's darker half, the light that both halves contain.
constexpr float kOfDarkerHalf = 2;

/// Number of iterations of the means. In each, a pixel contributes at most its previous limit, so that it has little
/// effect on its own limit.
constexpr int kRounds = 4;
/// In the second iteration, a pixel contributes at most this multiple of the limit of an adjacent window, however
/// bright it is.
constexpr float kOfWindowBeside = 8;

/// Noise, in units of the limit, up to which an outlier is reduced to its limit, so that little is lost if there are
/// many. From twice this value, it is reduced to its darker half, since the limit would still be visible as a dot.
constexpr float kFading = 8;

/// Minimum fraction of its light that an outlier keeps, so that the original can be recovered from the rest.
constexpr float kMinFactor = 0x1p-40F;

/// Maximum relative standard deviation of the image's mean caused by spreading the light of outliers over the image;
/// more would flicker from frame to frame.
constexpr double kLargestFlicker = 0.02;

/// A colour of a half.
std::array<float, 3> color(const std::vector<HalfPair>& halves, const Values* HalfPair::*half, std::size_t pixel) {
  std::array<float, 3> out{};
  for (std::size_t c = 0; c < 3; ++c) out[c] = usable((*(halves[c].*half))[pixel]);
  return out;
}
float sum(const std::array<float, 3>& v) { return v[0] + v[1] + v[2]; }

/// Square root of the variance of a pixel, summed over the channels.
float noise(const std::array<float, 3>& a, const std::array<float, 3>& b) {
  float squares = 0;
  for (std::size_t c = 0; c < 3; ++c) squares += (a[c] - b[c]) * (a[c] - b[c]);
  return std::sqrt(squares) / 2;
}

/// Light of the darker half, in the unit of noise().
float darker(const std::array<float, 3>& a, const std::array<float, 3>& b) {
  return std::max(std::min(sum(a), sum(b)), 0.0F) / std::sqrt(3.0F);
}

/// Means over the windows of pixels, shifted to lie within the image: with repeated edge pixels, they would average few
/// distinct pixels.
Values means_inside(const Values& in, Frame frame) {
  const Values means = window_means(in, frame, kWindowRadius);
  const auto inside = [](int at, int length) {
    const int middle = (length - 1) / 2;
    return std::clamp(at, std::min(kWindowRadius, middle), std::max(length - 1 - kWindowRadius, middle));
  };
  return frame.each([&](int x, int y) { return means[frame.at(inside(x, frame.width), inside(y, frame.height))]; });
}

/// Limits of the noise of each pixel, from the noise and the light of its window.
Values noise_limits(const Values& noises, const Values& darker_halves, Frame frame) {
  Values limits = noises;
  for (int round = 0; round < kRounds; ++round) {
    const Values sums = frame.each_index([&](std::size_t i) {
      return kOfLight * darker_halves[i] + (kOfLight + kOfNoise) * std::min(noises[i], limits[i]);
    });
    limits = means_inside(sums, frame);
    if (round > 0) continue;
    limits = least_around(limits, frame, kWindowRadius + 1);
    for (float& limit : limits) limit *= kOfWindowBeside;
  }
  return limits;
}

/// `limit`    limit that the pixel's noise exceeds
Outlier outlier_of(std::size_t pixel, const std::array<float, 3>& a, const std::array<float, 3>& b, float limit) {
  const float limits = noise(a, b) / limit;
  Outlier out{pixel, sum(a) > sum(b), true, std::clamp(2 - limits / kFading, 0.0F, 1.0F) / limits, {}};
  for (std::size_t c = 0; c < 3; ++c) {
    const float low = out.is_in_a ? b[c] : a[c], whole = a[c] + b[c];
    const float left = low + low + out.kept * (whole - low - low);
    out.factors[c] = whole > 0 ? std::clamp(left / whole, kMinFactor, 1.0F) : 1.0F;
  }
  return out;
}

/// Keeps the light of the brightest outliers where it is, so that the rest can be spread over an image of `light`
/// without changing it visibly.
void return_brightest(std::vector<Outlier>& outliers, const std::vector<double>& removed, double light) {
  std::vector<std::size_t> order(outliers.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(),
            [&](std::size_t i, std::size_t k) { return removed[i] != removed[k] ? removed[i] < removed[k] : i < k; });
  double squares = 0;
  for (const std::size_t i : order) {
    squares += removed[i] * removed[i];
    outliers[i].is_spread = std::sqrt(squares) <= kLargestFlicker * light;
  }
}

}  // namespace

Outliers find_outliers(const std::vector<HalfPair>& halves, Frame frame) {
  const auto a = [&](std::size_t i) { return color(halves, &HalfPair::a, i); };
  const auto b = [&](std::size_t i) { return color(halves, &HalfPair::b, i); };
  const Values noises = frame.each_index([&](std::size_t i) { return noise(a(i), b(i)); });
  const Values darker_halves = frame.each_index([&](std::size_t i) { return darker(a(i), b(i)); });
  Outliers out;
  out.limits = noise_limits(noises, darker_halves, frame);
  struct Row {
    std::vector<Outlier> outliers;
    std::vector<double> removed;  ///< light, of each outlier
    double light = 0;             ///< that is left
  };
  std::vector<Row> rows(static_cast<std::size_t>(frame.height));
  frame.each_row([&](int y) {
    Row& row = rows[static_cast<std::size_t>(y)];
    for (std::size_t i = frame.at(0, y); i < frame.at(0, y) + static_cast<std::size_t>(frame.width); ++i) {
      const float limit = std::max(out.limits[i], kOfDarkerHalf * darker_halves[i]);
      row.light += static_cast<double>(sum(a(i)) + sum(b(i))) / 2;
      if (noises[i] <= limit) continue;
      row.outliers.push_back(outlier_of(i, a(i), b(i), limit));
      double removed = 0;
      for (std::size_t c = 0; c < 3; ++c)
        removed += static_cast<double>((a(i)[c] + b(i)[c]) / 2 * (1 - row.outliers.back().factors[c]));
      row.removed.push_back(removed);
      row.light -= removed;
    }
  });
  std::vector<double> removed;
  double light = 0;
  for (const Row& row : rows) {
    out.pixels.insert(out.pixels.end(), row.outliers.begin(), row.outliers.end());
    removed.insert(removed.end(), row.removed.begin(), row.removed.end());
    light += row.light;
  }
  return_brightest(out.pixels, removed, light);
  return out;
}

}  // namespace orrery::denoise
