// SPDX-License-Identifier: Apache-2.0
#include "compile/pixel_filter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/scene.h"

namespace orrery::compile {
namespace {

using kernel::PixelFilter;

/// Intervals of numerical integration over half the filter width: far finer than the resulting table.
constexpr int kParts = 1 << 16;

/// Returns the midpoint of an interval, 0 .. 0.5 of the filter width.
double place(int part) { return (part + 0.5) / kParts / 2; }

// The filters at 0 .. 0.5 of their width, not normalised.
double box(double) { return 1; }
double gaussian(double x) { return std::exp(-18 * x * x); }  // the width is six standard deviations
double blackman_harris(double x) {
  const double turn = 2 * std::numbers::pi * (x + 0.5);
  return 0.35875 - 0.48829 * std::cos(turn) + 0.14128 * std::cos(2 * turn) - 0.01168 * std::cos(3 * turn);
}
/// With B = C = 1/3.
double mitchell(double at) {
  const double x = std::abs(4 * at);
  if (x < 1) return (7 * x * x * x - 12 * x * x + 16.0 / 3) / 6;
  return (-7.0 / 3 * x * x * x + 12 * x * x - 20 * x + 32.0 / 3) / 6;
}

double (*function_of(scene::Filter filter))(double) {
  switch (filter) {
    case scene::Filter::kBox: return box;
    case scene::Filter::kGaussian: return gaussian;
    case scene::Filter::kBlackmanHarris: return blackman_harris;
    case scene::Filter::kMitchell: return mitchell;
  }
  return box;
}

/// Returns the inverse of the cumulative distribution of `density` over 0 .. 0.5 of the width, at even steps, in
/// pixels.
template <class Density>
std::vector<double> inverse(Density density, double width) {
  double total = 0;
  for (int i = 0; i < kParts; ++i) total += density(place(i));
  std::vector<double> table;
  double sum = 0, end = 0;
  for (int i = 0; i < kParts; ++i) {
    const double part = density(place(i));
    if (part <= 0) continue;
    while (table.size() <= PixelFilter::kSteps) {
      const double missing = total * static_cast<double>(table.size()) / PixelFilter::kSteps - sum;
      if (missing > part) break;
      // Rounded so that the last bit of the math library does not matter: images are the same everywhere.
      table.push_back(std::round((i + missing / part) / kParts / 2 * width * 0x1p24) * 0x1p-24);
    }
    sum += part;
    end = (i + 1.0) / kParts / 2 * width;
  }
  table.resize(PixelFilter::kSteps + 1, end);
  return table;
}

}  // namespace

kernel::PixelFilter FilterTables::view() const noexcept {
  PixelFilter v;
  if (above.empty()) return v;
  v.above = above.data();
  if (below.empty()) return v;
  v.below = below.data();
  const double negative = 2 * below_mass, positive = 1 + below_mass * below_mass;
  v.negative_share = static_cast<std::uint32_t>(std::lround(negative / (negative + positive) * 0x1p32));
  v.below_twice = std::round(below_mass * below_mass / positive * 0x1p32) * 0x1p-32;
  return v;
}

double filter_width(const scene::Render& render) {
  if (render.filter_width) return *render.filter_width;
  switch (render.filter) {
    case scene::Filter::kBox: return 1;
    case scene::Filter::kGaussian:
    case scene::Filter::kBlackmanHarris: return 3;
    case scene::Filter::kMitchell: return 4;
  }
  return 1;
}

FilterTables compile_filter(const scene::Render& render) {
  FilterTables out;
  const double width = filter_width(render);
  if (render.filter == scene::Filter::kBox && width == 1) return out;
  const auto f = function_of(render.filter);
  const auto above = [f](double x) { return std::max(f(x), 0.0); };
  const auto below = [f](double x) { return std::max(-f(x), 0.0); };
  double sum_above = 0, sum_below = 0;
  for (int i = 0; i < kParts; ++i) {
    sum_above += above(place(i));
    sum_below += below(place(i));
  }
  out.above = inverse(above, width);
  if (render.filter != scene::Filter::kMitchell) return out;
  out.below = inverse(below, width);
  out.below_mass = std::round(sum_below / sum_above * 0x1p32) * 0x1p-32;
  return out;
}

}  // namespace orrery::compile
