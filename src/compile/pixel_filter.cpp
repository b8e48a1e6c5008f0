// SPDX-License-Identifier: Apache-2.0
#include "compile/pixel_filter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernel/camera.h"
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

double (*function_of(scene::Filter filter))(double) {
  switch (filter) {
    case scene::Filter::kBox: return box;
    case scene::Filter::kGaussian: return gaussian;
    case scene::Filter::kBlackmanHarris: return blackman_harris;
  }
  return box;
}

/// Returns the inverse of the cumulative distribution of `density` over 0 .. 0.5 of the width, at even steps, in
/// pixels.
std::vector<double> inverse(double (*density)(double), double width) {
  double total = 0;
  for (int i = 0; i < kParts; ++i) total += density(place(i));
  std::vector<double> table;
  double sum = 0, end = 0;
  for (int i = 0; i < kParts; ++i) {
    const double part = density(place(i));
    if (part <= 0) continue;  // rounding error at the end of a window
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

double filter_width(const scene::Render& render) {
  if (render.filter_width) return *render.filter_width;
  switch (render.filter) {
    case scene::Filter::kBox: return 1;
    case scene::Filter::kGaussian:
    case scene::Filter::kBlackmanHarris: return 3;
  }
  return 1;
}

std::vector<double> compile_filter(const scene::Render& render) {
  const double width = filter_width(render);
  if (render.filter == scene::Filter::kBox && width == 1) return {};
  return inverse(function_of(render.filter), width);
}

}  // namespace orrery::compile
