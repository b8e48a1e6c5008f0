// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenImageIO/imageio.h>

#include <limits>
#include <vector>

#include "film/picture.h"
#include "image/write.h"

namespace orrery::image {

/// What the numbers of a file can hold.
struct Range {
  float smallest, largest;
};

inline constexpr Range kHalfRange{-film::kLargestHalf, film::kLargestHalf};
inline constexpr Range kFloatRange{std::numeric_limits<float>::lowest(), std::numeric_limits<float>::max()};
/// A Radiance pixel's exponent ends at 2^127, its mantissa has eight bits.
inline constexpr Range kRadianceRange{0, 0x1.fep126f};

/// Planes side by side, pixel by pixel, fit for the file.
///
/// Errors     base::Error(kInternal) for planes that are not of the picture's size
std::vector<float> interleaved(const film::Picture& picture, const std::vector<const film::Plane*>& planes,
                               const std::vector<Range>& ranges, WriteReport& report);

/// Attributes of our own.
void add_attributes(OIIO::ImageSpec& spec, const std::vector<Attribute>& attributes);

/// All that a header says but for mattes.
void add_header(OIIO::ImageSpec& spec, const Header& header);

/// The part of its frame that a picture is.
void add_windows(OIIO::ImageSpec& spec, const film::Picture& picture);

}  // namespace orrery::image
