// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenImageIO/imageio.h>

#include <limits>
#include <vector>

#include "film/picture.h"
#include "image/header.h"
#include "image/write.h"

namespace orrery::image {

/// Value range of a file's number type.
struct Range {
  float smallest, largest;
};

inline constexpr Range kHalfRange{-film::kLargestHalf, film::kLargestHalf};
inline constexpr Range kFloatRange{std::numeric_limits<float>::lowest(), std::numeric_limits<float>::max()};
/// A Radiance pixel has an eight-bit mantissa; its maximum is 255/256 * 2^127.
inline constexpr Range kRadianceRange{0, 0x1.fep126f};

/// Interleaves planes pixel by pixel. Clamps values to the ranges, replaces non-finite ones by 0, and counts both.
///
/// Errors     base::Error(kInternal) for planes that do not have the size of the image
std::vector<float> interleaved(const film::Picture& picture, const std::vector<const film::Plane*>& planes,
                               const std::vector<Range>& ranges, WriteReport& report);

/// Adds orrery's attributes to a spec.
void add_attributes(OIIO::ImageSpec& spec, const std::vector<Attribute>& attributes);

/// Adds all attributes of a header to a spec, except those of mattes.
void add_header(OIIO::ImageSpec& spec, const Header& header);

/// Sets the data and display windows and the pixel aspect ratio.
void add_windows(OIIO::ImageSpec& spec, const film::Picture& picture);

}  // namespace orrery::image
