// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace orrery::measure {

struct Point;
struct Slope;

/// Family-wise error rate: the probability that a study of unbiased choices reports a bias in any of them.
inline constexpr double kFamilyWiseError = 0.01;

/// Tests all points for an error common to both renders, and sets bias, error and efficiency of every point.
///
/// Only shortcuts have a bias. Other choices converge to the same image as the reference: light that both of their
/// renders lack has not been found yet, and counts as error only.
///
/// Reference  holm1979
void test_bias(std::vector<Point>& points);

/// The convergence rate of each sampler with at least two points, by a least-squares fit on logarithmic axes.
std::vector<Slope> slopes_of(const std::vector<Point>& points);

/// Marks the points on the Pareto front of time and error. Accelerators are excluded, since their images are identical.
void mark_front(std::vector<Point>& points);

}  // namespace orrery::measure
