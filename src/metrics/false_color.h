// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "film/picture.h"
#include "metrics/color_view.h"

namespace orrery::metrics {

/// Maps the values 0 .. `full` to the colour map magma, from black through violet and orange to pale yellow.
///
/// Result     sRGB-encoded values 0..1
/// Reference  matplotlib's "magma", sampled at every sixteenth entry
film::Picture false_color(const Map& map, double full);

/// Quantizes an sRGB-encoded image to 8 bits.
///
/// Domain     planes R, G, B; values are clamped to 0..1
film::EncodedPicture encoded(const film::Picture& codes);

/// A map as a grey image with the same values in R, G and B.
film::Picture grey(const Map& map);

/// Display error at the upper end of a heat map's scale.
inline constexpr double kFalseColorMax = 0.1;

}  // namespace orrery::metrics
