// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "film/picture.h"

namespace orrery::study {

/// What two pictures of the same choice, with different seeds, are off by; as in Point.
struct Errors {
  double error = 0, bias = 0, noise = 0, energy = 0;
};

/// Tells bias from noise. What two independent pictures are off by together is the square of the bias, and of the
/// reference's own noise, which is known; half of what they differ by is noise.
///
/// Domain     pictures of one size with planes R, G, B
Errors errors_of(const film::Picture& a, const film::Picture& b, const film::Picture& reference,
                 double reference_noise);

}  // namespace orrery::study
