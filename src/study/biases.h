// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "film/picture.h"

namespace orrery::study {

struct Errors;
struct Point;
struct Slope;

/// Two renders of the same image with independent random numbers.
struct Pair {
  film::Picture first, second;
};

/// The mean of both images.
film::Picture mean_of(const Pair& pair);

/// Warns if the times of two renders of one setting differ so much that neither can be trusted.
///
/// Result     empty up to a ratio of 1.3
std::string spread_warning(double first_s, double second_s);

/// The display error of that mean, estimated from the difference of the two images.
double noise_of_mean(const Pair& pair);

/// Effective number of pixels that must show a bias.
inline constexpr double kMinEffectiveCount = 20;

/// Estimates noise and bias of a choice against the reference.
///
/// With x, y the images of the choice and r, s those of the reference, the mean over pixels of (x - r)(y - s) estimates
/// the squared bias without any contribution of noise, since the four images are independent. Without bias its terms
/// are symmetric around zero or skewed to the right. Their sum divided by the root of the sum of their squares then
/// exceeds t with a probability of at most exp(-t^2 / 2), however much the noise varies between pixels.
///
/// Light that only a handful of paths have found violates this assumption: it is missing in most pixels of both
/// renders. Therefore, bias_chance is 1 unless the effective number of terms is at least kMinEffectiveCount: n terms of
/// equal size count as n, a few dominant terms as few. A bias confined to fewer pixels is not detected.
///
/// Domain     images of one size with planes R, G, B; pixels do not share random numbers
/// Reference  efron1969
Errors errors_of(const Pair& choice, const Pair& reference);

/// Tests all points for an error common to both renders, and sets bias, error and efficiency of every point. The
/// probability that a study of unbiased choices reports a bias in any of them is at most compare::kFamilyWiseError.
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

}  // namespace orrery::study
