// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "base/image_limits.h"

namespace orrery::scene {

/// Maximum absolute shutter time relative to the frame, frames.
inline constexpr double kLongestShutter = 100;

/// Maximum absolute frame number of a [[key]], and maximum turntable length, frames.
inline constexpr double kMaxFrame = 1e6;

/// Maximum absolute coordinate and radius, scene units: squares and products of squares stay well within the range of a
/// double.
inline constexpr double kLargestLength = 1e18;

/// Maximum absolute value at the ends of a colour map, in the unit of the column, so that their difference is finite.
inline constexpr double kLargestValue = 1e300;

/// Minimum absolute radius, and minimum length of a vector that defines a direction, scene units: their squares keep
/// full precision.
inline constexpr double kSmallestRadius = 1e-30;

/// The same for spheres in precision `fast`: the square of the radius is a normal number of single precision.
inline constexpr double kSmallestFastRadius = 1e-18;

/// Default of `bonds.factor` in [[points]]. The sum of two covalent radii is the length of a single bond within a few
/// hundredths; distances between atoms that are not bonded begin at about 1.4 times the sum.
///
/// Reference  cordero2008, meng1991
inline constexpr double kDefaultBondFactor = 1.2;

/// Maximum of `bonds.factor`; more than 3 would bond second neighbours.
inline constexpr double kLargestBondFactor = 100;

/// Maximum number of spheres of a scene: ids have 32 bits, and the largest id means none.
inline constexpr std::size_t kMaxSpheres = 0xFFFFFFFF;

/// Minimum sine of the angle between the view direction and `up`; below it, rounding errors would determine the camera
/// roll.
inline constexpr double kSmallestUpSine = 1e-9;

using base::kLargestSide;

/// Maximum width of outlines, px: the search for edges takes time in proportion to its square.
inline constexpr double kWidestOutline = 64;

/// Maximum radiance of a light or background, also after exposure: half of kernel::kLargestSample, so that a pixel's
/// sums hold it. The luminance of the sun, 1.6e9 cd/m2, is less. A path whose total exceeds kLargestSample is a bad
/// sample.
inline constexpr double kBrightestLight = 0x1p34;
inline constexpr const char* kBrighterLightRemedy =
    "divide the light of the whole scene by one factor, and raise color.exposure";

/// Maximum absolute rotation of the background, degrees: an animation may make many turns.
inline constexpr double kLargestRotation = 1e6;

/// Maximum overscan, px; for a wider border, use a larger frame.
inline constexpr int kWidestOverscan = 4096;

/// Maximum absolute exposure, stops: no scene needs more.
inline constexpr double kMaxStops = 100;

/// Range of the turbidity of a daylight sky: from pure air to haze in which the model's errors become large.
inline constexpr double kLowestTurbidity = 1, kHighestTurbidity = 10;

/// Maximum pixel filter width, px; a wider filter is a blur.
inline constexpr double kWidestFilter = 32;

/// Range of a texture's scale: products with the largest coordinate are finite in single precision.
inline constexpr double kSmallestScale = 1e-18, kLargestScale = 1e18;

/// Maximum path depth, rays; with more, renders could take practically forever.
inline constexpr int kDeepestPath = 10000;

using base::kMaxLightGroups;

/// Maximum number of copies of a points file along an axis.
inline constexpr int kMaxCopies = 1000;

/// Maximum length of a light group's name, bytes: EXR channel names have up to 255 bytes, and
/// "_transmission_indirect.R" has 24.
inline constexpr std::size_t kLongestLightGroup = 231;

}  // namespace orrery::scene
