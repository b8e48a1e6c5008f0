// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "film/encoded_picture.h"
#include "film/picture.h"
#include "metrics/color_view.h"

namespace orrery::metrics {

/// A map as colours from black over violet and orange to pale yellow, 0 .. `full` of it; codes 0..1 of an sRGB screen.
///
/// Reference  the colour map "magma" of matplotlib, at every sixteenth step
film::Picture false_color(const Map& map, double full);

/// Codes 0..1 in 8 bits.
///
/// Domain     planes R, G, B
film::EncodedPicture encoded(const film::Picture& codes);

/// A map as a grey picture of its own numbers.
film::Picture grey(const Map& map);

}  // namespace orrery::metrics
