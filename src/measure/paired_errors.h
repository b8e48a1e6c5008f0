// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "film/picture.h"

namespace orrery::measure {

/// Two renders of the same picture that share no random number.
struct Pair {
  film::Picture first, second;
};

/// The mean of both.
film::Picture mean_of(const Pair& pair);

/// Display error of that mean, from how much the two differ.
double noise_of_mean(const Pair& pair);

/// Errors of the pictures of a pair, as in Point.
struct Errors {
  double noise = 0;
  double bias_squared = 0;
  double bias_chance = 1;
  double energy = 0;
};

/// Compares a choice with the reference.
///
/// With x, y the choice and r, s the reference, the mean over pixels of (x - r)(y - s) estimates the squared bias
/// without any contribution of noise, since the four are independent. Without a bias its terms are symmetric around
/// zero, or skewed to the right, so that their sum, divided by the root of the sum of their squares, exceeds t with a
/// probability of at most exp(-t^2 / 2), however much the noise differs between pixels. A bias of less than some 20
/// pixels is not found.
///
/// Domain     pictures of one size with planes R, G, B
/// Reference  efron1969
Errors errors_of(const Pair& choice, const Pair& reference);

}  // namespace orrery::measure
