// SPDX-License-Identifier: Apache-2.0
#include "denoise/light_balance.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>

namespace orrery::denoise {
namespace {

/// The light of a few very bright pixels, spread over a dark part, would be visible.
constexpr double kLargestLift = 0.05;

/// Position of a pixel between two parts: the first of them, and the weight of the second.
struct Between {
  int part;
  double weight;
};
Between between(int pixel) { return {pixel / kPartSpacing, (pixel % kPartSpacing + 0.5) / kPartSpacing}; }

/// Light that a pixel gained, at most all that it has.
double gain(float before, float after) {
  return std::max(static_cast<double>(after) - static_cast<double>(std::max(before, 0.0F)), 0.0);
}

}  // namespace

LightBalance::LightBalance(const PaddedPlane& before, const Values& after, const PaddedPlane& valid, Frame frame)
    : columns_(between(frame.width - 1).part + 2) {
  const int rows = between(frame.height - 1).part + 2;
  parts_.resize(static_cast<std::size_t>(columns_ * rows));
  tbb::parallel_for(0, rows, [&](int row) {
    struct Light {
      double loss = 0, gains = 0, after = 0;
    };
    std::vector<Light> sums(static_cast<std::size_t>(columns_));
    const int end = std::min((row + 1) * kPartSpacing, frame.height);
    for (int y = std::max((row - 1) * kPartSpacing, 0); y < end; ++y) {
      const Between vertical = between(y);
      const double of_row = vertical.part == row ? 1 - vertical.weight : vertical.weight;
      for (int x = 0; x < frame.width; ++x) {
        if (*valid.at(x, y) == 0) continue;
        const float was = *before.at(x, y), is = after[frame.at(x, y)];
        const Between horizontal = between(x);
        const auto add = [&](int column, double weight) {
          Light& sum = sums[static_cast<std::size_t>(column)];
          sum.loss += weight * (static_cast<double>(was) - static_cast<double>(is));
          sum.gains += weight * gain(was, is);
          sum.after += weight * static_cast<double>(is);
        };
        add(horizontal.part, of_row * (1 - horizontal.weight));
        add(horizontal.part + 1, of_row * horizontal.weight);
      }
    }
    for (int column = 0; column < columns_; ++column) {
      const Light& sum = sums[static_cast<std::size_t>(column)];
      Part& part = parts_[static_cast<std::size_t>(row * columns_ + column)];
      if (sum.loss > 0 && sum.after > 0) part.lift = std::min(sum.loss / sum.after, kLargestLift);
      if (sum.loss < 0 && sum.gains > 0) part.share = std::min(-sum.loss / sum.gains, 1.0);
    }
  });
}

double LightBalance::at(int x, int y, float before, float after) const {
  if (!(after > 0)) return 1;
  const Between horizontal = between(x), vertical = between(y);
  const Part* const above = parts_.data() + vertical.part * columns_ + horizontal.part;
  const auto interpolate = [&](double Part::*member) {
    const auto in_row = [&](const Part* pair) {
      return pair[0].*member + (pair[1].*member - pair[0].*member) * horizontal.weight;
    };
    const double first = in_row(above);
    return first + (in_row(above + columns_) - first) * vertical.weight;
  };
  const double given_back = interpolate(&Part::share) * gain(before, after);
  return 1 + interpolate(&Part::lift) - given_back / static_cast<double>(after);
}

}  // namespace orrery::denoise
