// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace orrery::scene {

/// Maximum absolute shutter time relative to the frame, frames.
inline constexpr double kLongestShutter = 100;

/// Maximum absolute frame number of a [[key]], and maximum turntable length, frames.
inline constexpr double kMaxFrame = 1e6;

/// Maximum absolute coordinate and radius, scene units: squares and products of squares stay far inside the range of a
/// double.
inline constexpr double kLargestLength = 1e18;

/// Minimum absolute radius, and minimum length of a vector that defines a direction, scene units: their squares keep
/// full precision.
inline constexpr double kSmallestRadius = 1e-30;

/// Minimum sine of the angle between the view direction and `up`: below it, the camera roll would be rounding error.
inline constexpr double kSmallestUpSine = 1e-9;

/// Maximum image width and height, px: a pixel id is y << 16 | x.
inline constexpr int kLargestSide = 65536;

/// Maximum background radiance: the sum of a pixel's samples then fits into 128 bits.
inline constexpr double kBrightestBackground = 1e6;

/// Maximum overscan, px: a wider border calls for a larger frame.
inline constexpr int kWidestOverscan = 4096;

/// Maximum absolute exposure, stops: no scene needs more, and 2^100 is as good as infinity.
inline constexpr double kMaxStops = 100;

/// Maximum pixel filter width, px: a wider filter is a blur.
inline constexpr double kWidestFilter = 32;

/// Maximum path depth, rays: with more, a render would not end in practice.
inline constexpr int kDeepestPath = 10000;

}  // namespace orrery::scene
