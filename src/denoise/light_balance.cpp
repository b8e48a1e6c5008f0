// SPDX-License-Identifier: Apache-2.0
#include "denoise/light_balance.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace orrery::denoise {
namespace {

/// Limited, because the light of a few very bright pixels would be visible if spread over a dark part.
constexpr double kLargestLift = 0.05;
/// The same limit for the light of a single outlier, which would flicker from frame to frame.
constexpr double kLargestLiftOfOutlier = 0.02;

/// Position of a pixel between two parts: the first of them, and the weight of the second.
struct GridPosition {
  int part;
  double weight;
};
GridPosition grid_position(int pixel) { return {pixel / kPartSpacing, (pixel % kPartSpacing + 0.5) / kPartSpacing}; }

/// Light that a pixel gained, at most all of its light.
double gain(float before, float after) {
  return std::max(static_cast<double>(after) - static_cast<double>(std::max(before, 0.0F)), 0.0);
}

/// Light of a part: sums weighted by its tent.
struct Light {
  double loss = 0, gains = 0, after = 0;
  double removed = 0, removed_squares = 0;

  /// Fraction of the light by which a part is brightened for what it lost to the filter.
  double lift_of_loss() const { return loss > 0 && after > 0 ? std::min(loss / after, kLargestLift) : 0; }
  /// The same for the light of outliers. The limit grows with their number, which is then statistically more certain.
  double lift_of_removed() const {
    if (!(removed > 0 && after > 0)) return 0;
    return std::min(removed / after, kLargestLiftOfOutlier * std::max(removed / std::sqrt(removed_squares), 1.0));
  }
};

}  // namespace

LightBalance::LightBalance(const PaddedPlane& before, const Values& after, const PaddedPlane& valid, Frame frame,
                           const std::vector<RemovedLight>& removed)
    : columns_(grid_position(frame.width - 1).part + 2) {
  const int rows = grid_position(frame.height - 1).part + 2;
  parts_.resize(static_cast<std::size_t>(columns_ * rows));
  std::vector<Light> sums(parts_.size());
  tbb::parallel_for(0, rows, [&](int row) {
    Light* const of_row = sums.data() + row * columns_;
    const int end = std::min((row + 1) * kPartSpacing, frame.height);
    for (int y = std::max((row - 1) * kPartSpacing, 0); y < end; ++y) {
      const GridPosition vertical = grid_position(y);
      const double weight_of_row = vertical.part == row ? 1 - vertical.weight : vertical.weight;
      const auto add = [&](int x, auto add_to) {
        const GridPosition horizontal = grid_position(x);
        add_to(of_row[horizontal.part], weight_of_row * (1 - horizontal.weight));
        add_to(of_row[horizontal.part + 1], weight_of_row * horizontal.weight);
      };
      for (int x = 0; x < frame.width; ++x) {
        if (*valid.at(x, y) == 0) continue;
        const float was = *before.at(x, y), is = after[frame.at(x, y)];
        add(x, [&](Light& sum, double weight) {
          sum.loss += weight * (static_cast<double>(was) - static_cast<double>(is));
          sum.gains += weight * gain(was, is);
          sum.after += weight * static_cast<double>(is);
        });
      }
      const auto is_before = [](const RemovedLight& r, std::size_t pixel) { return r.pixel < pixel; };
      const std::size_t first = frame.at(0, y), next_row = first + static_cast<std::size_t>(frame.width);
      for (auto r = std::lower_bound(removed.begin(), removed.end(), first, is_before);
           r != removed.end() && r->pixel < next_row; ++r)
        add(static_cast<int>(r->pixel - first), [&](Light& sum, double weight) {
          sum.removed += weight * r->light;
          sum.removed_squares += weight * r->light * weight * r->light;
        });
    }
    for (int column = 0; column < columns_; ++column) {
      const Light& sum = of_row[column];
      Part& part = parts_[static_cast<std::size_t>(row * columns_ + column)];
      part.lift = sum.lift_of_loss() + sum.lift_of_removed();
      if (sum.loss < 0 && sum.gains > 0) part.share = std::min(-sum.loss / sum.gains, 1.0);
    }
  });
  double rest = 0, all = 0;
  for (const Light& sum : sums) {
    all += sum.after;
    rest += sum.removed - sum.lift_of_removed() * sum.after;
  }
  if (rest > 0 && all > 0) lift_ = rest / all;
}

double LightBalance::at(int x, int y, float before, float after) const {
  if (!(after > 0)) return 1;
  const GridPosition horizontal = grid_position(x), vertical = grid_position(y);
  const Part* const above = parts_.data() + vertical.part * columns_ + horizontal.part;
  const auto interpolate = [&](double Part::*member) {
    const auto in_row = [&](const Part* pair) {
      return pair[0].*member + (pair[1].*member - pair[0].*member) * horizontal.weight;
    };
    const double first = in_row(above);
    return first + (in_row(above + columns_) - first) * vertical.weight;
  };
  const double given_back = interpolate(&Part::share) * gain(before, after);
  return 1 + lift_ + interpolate(&Part::lift) - given_back / static_cast<double>(after);
}

}  // namespace orrery::denoise
