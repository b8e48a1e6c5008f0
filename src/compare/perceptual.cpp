// SPDX-License-Identifier: Apache-2.0
#include "compare/perceptual.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <mutex>
#include <numbers>

#include "compare/color_view.h"
#include "render/tiles.h"

namespace orrery::compare {
namespace {

/// Samples `shape` at -radius .. radius and normalizes the taps to a sum of 1.
Taps taps_of(int radius, const std::function<double(double)>& shape) {
  double sum = 0;
  for (int x = -radius; x <= radius; ++x) sum += shape(x);
  Taps taps;
  for (int x = -radius; x <= radius; ++x) taps.push_back(static_cast<float>(shape(x) / sum));
  return taps;
}

auto gaussian(double sigma) {
  return [sigma](double x) { return std::exp(-x * x / (2 * sigma * sigma)); };
}

Map luma(const Maps& m) {
  Map out = m[0];
  for (std::size_t i = 0; i < out.values.size(); ++i)
    out.values[i] = 0.299f * m[0].values[i] + 0.587f * m[1].values[i] + 0.114f * m[2].values[i];
  return out;
}

Map product(const Map& a, const Map& b) {
  Map out = a;
  for (std::size_t i = 0; i < out.values.size(); ++i) out.values[i] *= b.values[i];
  return out;
}

}  // namespace

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

double ssim(const Maps& picture, const Maps& reference) {
  constexpr double kC1 = 0.01 * 0.01, kC2 = 0.03 * 0.03;
  const Taps taps = taps_of(5, gaussian(1.5));
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

namespace {

using Color = std::array<float, 3>;

// The symbols used in the papers are given in the comments.
constexpr float kColorExponent = 0.7f;    // q_c
constexpr float kFeatureExponent = 0.5f;  // q_f
constexpr float kColorKnee = 0.4f;        // p_c
constexpr float kErrorAtKnee = 0.95f;     // p_t
constexpr double kFeatureWidth = 0.082;   // w, degrees
constexpr double kShown = 0.85;           // t, the tone-mapped value that sets both ends of the exposure range

// Conversion between linear Rec. 709 and CIE XYZ relative to the D65 white, which maps to (1, 1, 1).
constexpr double kWhite[3] = {0.950428545, 1, 1.088900371};
constexpr double kToXyz[3][3] = {{10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794},
                                 {2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897},
                                 {1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382}};
constexpr double kFromXyz[3][3] = {{3.241003275, -1.537398934, -0.498615861},
                                   {-0.969224334, 1.875930071, 0.041554224},
                                   {0.055639423, -0.204011202, 1.057148933}};

Color white_relative(const Color& light) {
  Color out;
  for (std::size_t r = 0; r < 3; ++r) {
    double sum = 0;
    for (std::size_t c = 0; c < 3; ++c) sum += kToXyz[r][c] * static_cast<double>(light[c]);
    out[r] = static_cast<float>(sum / kWhite[r]);
  }
  return out;
}
Color light_of(const Color& relative) {
  Color out;
  for (std::size_t r = 0; r < 3; ++r) {
    double sum = 0;
    for (std::size_t c = 0; c < 3; ++c) sum += kFromXyz[r][c] * static_cast<double>(relative[c]) * kWhite[c];
    out[r] = static_cast<float>(sum);
  }
  return out;
}

/// Opponent colour: brightness, red-green, yellow-blue. Linear, without the cube root of L*a*b*, so that it can be
/// filtered.
Color opponent(const Color& light) {
  const Color n = white_relative(light);
  return {116 * n[1] - 16, 500 * (n[0] - n[1]), 200 * (n[1] - n[2])};
}
Color light_of_opponent(const Color& o) {
  const float y = (o[0] + 16) / 116;
  return light_of({y + o[1] / 500, y, y - o[2] / 200});
}

/// CIE L*a*b* with chroma scaled by lightness (Hunt effect).
Color hunt_lab(const Color& light) {
  constexpr float kDelta = 6.0f / 29;
  Color n = white_relative(light);
  for (float& v : n) v = v > kDelta * kDelta * kDelta ? std::cbrt(v) : v / (3 * kDelta * kDelta) + 4.0f / 29;
  const float l = 116 * n[1] - 16;
  return {l, 0.01f * l * 500 * (n[0] - n[1]), 0.01f * l * 200 * (n[1] - n[2])};
}

float hyab(const Color& a, const Color& b) { return std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]); }

/// Contrast sensitivity filters of the three opponent channels. The yellow-blue filter is a sum of two Gaussians.
struct EyeFilters {
  Taps brightness, red_green, blue_yellow[2];
  float share[2];

  EyeFilters() {
    constexpr double kPi2 = std::numbers::pi * std::numbers::pi;
    constexpr double kB[2] = {0.04, 0.025}, kA[2] = {34.1, 13.5};
    const int radius = static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * kPi2)) * kPixelsPerDegree));
    const auto shape = [&](double b) {
      return [=](double x) { return std::exp(-kPi2 * x * x / (kPixelsPerDegree * kPixelsPerDegree) / b); };
    };
    brightness = taps_of(radius, shape(0.0047));
    red_green = taps_of(radius, shape(0.0053));
    double weight[2];
    for (int i = 0; i < 2; ++i) {
      blue_yellow[i] = taps_of(radius, shape(kB[i]));
      double sum = 0;
      for (int x = -radius; x <= radius; ++x) sum += shape(kB[i])(x);
      weight[i] = kA[i] * std::sqrt(std::numbers::pi / kB[i]) * sum * sum;
    }
    for (int i = 0; i < 2; ++i) share[i] = static_cast<float>(weight[i] / (weight[0] + weight[1]));
  }
};

/// An image after the perceptual filters.
struct FilteredImage {
  Maps lab;      ///< colour after the contrast sensitivity filters
  Map features;  ///< edge strength
  Map points;    ///< point strength
};

template <class F>
Maps each_pixel(const Maps& from, F f) {
  Maps out = from;
  for (std::size_t i = 0; i < from[0].values.size(); ++i) {
    const Color c = f(Color{from[0].values[i], from[1].values[i], from[2].values[i]});
    for (std::size_t k = 0; k < 3; ++k) out[k].values[i] = c[k];
  }
  return out;
}

/// Feature strength: magnitude of the responses to a separable kernel applied along x and along y.
Map feature_strength(const Map& brightness, const Taps& across, const Taps& along) {
  Map x = convolved(brightness, across, along);
  const Map y = convolved(brightness, along, across);
  for (std::size_t i = 0; i < x.values.size(); ++i) x.values[i] = std::hypot(x.values[i], y.values[i]);
  return x;
}

/// A kernel whose positive taps sum to 1 and whose negative taps sum to -1.
Taps balanced(int radius, const std::function<double(double)>& shape) {
  double positive = 0, negative = 0;
  for (int x = -radius; x <= radius; ++x) (shape(x) > 0 ? positive : negative) += std::abs(shape(x));
  Taps taps;
  for (int x = -radius; x <= radius; ++x)
    taps.push_back(static_cast<float>(shape(x) / (shape(x) > 0 ? positive : negative)));
  return taps;
}

FilteredImage filtered_image(const Maps& codes) {
  const EyeFilters eye;
  Maps o = each_pixel(codes, [](const Color& code) {
    return opponent({srgb_decoded(code[0]), srgb_decoded(code[1]), srgb_decoded(code[2])});
  });
  Map brightness = o[0];
  for (float& v : brightness.values) v = (v + 16) / 116;

  o[0] = convolved(o[0], eye.brightness, eye.brightness);
  o[1] = convolved(o[1], eye.red_green, eye.red_green);
  const Map first = convolved(o[2], eye.blue_yellow[0], eye.blue_yellow[0]);
  o[2] = convolved(o[2], eye.blue_yellow[1], eye.blue_yellow[1]);
  for (std::size_t i = 0; i < first.values.size(); ++i)
    o[2].values[i] = eye.share[0] * first.values[i] + eye.share[1] * o[2].values[i];
  FilteredImage out;
  out.lab = each_pixel(o, [](const Color& v) {
    Color light = light_of_opponent(v);
    for (float& x : light) x = std::clamp(x, 0.0f, 1.0f);
    return hunt_lab(light);
  });

  const double sigma = kFeatureWidth / 2 * kPixelsPerDegree;
  const int radius = static_cast<int>(std::ceil(3 * sigma));
  const auto bell = gaussian(sigma);
  const Taps along = taps_of(radius, bell);
  out.features = feature_strength(brightness, balanced(radius, [&](double x) { return -x * bell(x); }), along);
  out.points = feature_strength(
      brightness, balanced(radius, [&](double x) { return (x * x / (sigma * sigma) - 1) * bell(x); }), along);
  return out;
}

Map flip(const FilteredImage& a, const FilteredImage& b) {
  const float farthest = std::pow(hyab(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1})), kColorExponent);
  const float knee = kColorKnee * farthest;
  Map out = a.features;
  for (std::size_t i = 0; i < out.values.size(); ++i) {
    const auto lab = [i](const FilteredImage& s) {
      return Color{s.lab[0].values[i], s.lab[1].values[i], s.lab[2].values[i]};
    };
    const float distance = std::pow(hyab(lab(a), lab(b)), kColorExponent);
    const float color = distance < knee ? distance * (kErrorAtKnee / knee)
                                        : kErrorAtKnee + (distance - knee) / (farthest - knee) * (1 - kErrorAtKnee);
    const float feature = std::max(std::abs(a.features.values[i] - b.features.values[i]),
                                   std::abs(a.points.values[i] - b.points.values[i]));
    out.values[i] = std::pow(color, 1 - std::pow(feature / std::numbers::sqrt2_v<float>, kFeatureExponent));
  }
  return out;
}

// The tone curve, a fit to the ACES reference rendering: (a x^2 + b x) / (c x^2 + d x + e).
constexpr double kTone[5] = {0.36 * 2.51, 0.6 * 0.03, 0.36 * 2.43, 0.6 * 0.59, 0.14};

float tone(float light) {
  const double x = static_cast<double>(light);
  if (x > 1e15) return 1;
  const double y = (kTone[0] * x + kTone[1]) * x / ((kTone[2] * x + kTone[3]) * x + kTone[4]);
  return static_cast<float>(std::clamp(y, 0.0, 1.0));
}

/// The inverse of the tone curve: the radiance that it maps to `t`.
double inverse_tone_curve(double t) {
  const double a = kTone[0] - t * kTone[2], b = (kTone[1] - t * kTone[3]) / a, c = -t * kTone[4] / a;
  return -b / 2 + std::sqrt(b * b / 4 - c);
}

/// The exposures in stops: from the one that maps the maximum luminance to kShown to the one that does so for the
/// median.
std::vector<double> exposures_for(const Maps& reference) {
  std::vector<double> luminance(reference[0].values.size());
  for (std::size_t i = 0; i < luminance.size(); ++i)
    luminance[i] = 0.2126 * static_cast<double>(reference[0].values[i]) +
                   0.7152 * static_cast<double>(reference[1].values[i]) +
                   0.0722 * static_cast<double>(reference[2].values[i]);
  const double brightest = *std::max_element(luminance.begin(), luminance.end());
  if (!(brightest > 0)) return {0.0};
  // For an even count the median is the mean of the two middle values.
  const auto middle = luminance.begin() + static_cast<std::ptrdiff_t>(luminance.size() / 2);
  std::nth_element(luminance.begin(), middle, luminance.end());
  double median = *middle;
  if (luminance.size() % 2 == 0) median = (median + *std::max_element(luminance.begin(), middle)) / 2;
  const double start = std::log2(inverse_tone_curve(kShown) / brightest);
  // Limits the number of exposures of a mostly black image: thirty stops below the maximum counts as black.
  const double stop = std::log2(inverse_tone_curve(kShown) / std::max(median, brightest * 0x1p-30));
  const int count = std::max(2, static_cast<int>(std::ceil(stop - start)));
  std::vector<double> out;
  for (int i = 0; i < count; ++i) out.push_back(start + i * (stop - start) / (count - 1));
  return out;
}

}  // namespace

Map flip(const Maps& picture, const Maps& reference) {
  return flip(filtered_image(picture), filtered_image(reference));
}

Map hdr_flip(const Maps& picture, const Maps& reference, int threads) {
  const std::vector<double> exposures = exposures_for(reference);
  Map out{reference[0].width, reference[0].height, std::vector<float>(reference[0].values.size())};
  std::mutex merging;
  const auto merge = [&](std::size_t i, render::TileWorker&) {
    const auto shown = [gain = static_cast<float>(std::exp2(exposures[i]))](Maps image) {
      for (Map& channel : image)
        for (float& v : channel.values) v = srgb_encoded(tone(std::max(v, 0.0f) * gain));
      return image;
    };
    const Map map = flip(shown(picture), shown(reference));
    const std::lock_guard lock(merging);
    for (std::size_t p = 0; p < out.values.size(); ++p) out.values[p] = std::max(out.values[p], map.values[p]);
  };
  render::TilePool(threads).run(exposures.size(), merge);
  return out;
}

}  // namespace orrery::compare
