// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "measure/study.h"

namespace orrery::measure {

/// Chance that a study of unbiased choices finds a bias in any of them.
inline constexpr double kFalseAlarm = 0.01;

/// Decides which choices are biased, all together, and sets bias, error and efficiency of every point.
///
/// Reference  holm1979
void judge_bias(std::vector<Point>& points);

/// How steeply the error of each sampler falls, by least squares on logarithmic axes, where it has two points or more.
std::vector<Slope> slopes_of(const std::vector<Point>& points);

/// Marks the points that nothing else is both quicker and better than. Accelerators, whose pictures are all the same,
/// stay out of it.
void mark_front(std::vector<Point>& points);

}  // namespace orrery::measure
