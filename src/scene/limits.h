// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace orrery::scene {

/// Frames before or behind its own that a picture's shutter may reach.
inline constexpr double kLongestShutter = 100;

/// Frames of a film.
inline constexpr double kMostFrames = 1e6;

/// Largest absolute coordinate and radius, scene units: its square and the square's products stay far inside a double.
inline constexpr double kLargestLength = 1e18;

/// Smallest absolute radius, and smallest distance that has a direction, scene units: its square keeps all its bits.
inline constexpr double kSmallestRadius = 1e-30;

/// Smallest sine of the angle between the view and `up`: below this the picture's roll would be rounding.
inline constexpr double kSmallestUpSine = 1e-9;

/// A pixel's name is y << 16 | x.
inline constexpr int kLargestSide = 65536;

/// Keeps the sum of a pixel's samples inside its 128 bits whatever the background.
inline constexpr double kBrightestBackground = 1e6;

/// More than this around a frame is another frame, px.
inline constexpr int kWidestOverscan = 4096;

/// More stops than any scene has: 2^100 would only be infinity by another name.
inline constexpr double kMaxStops = 100;

/// A wider filter is a blur, px.
inline constexpr double kWidestFilter = 32;

/// A path of more rays would only be a program that does not end.
inline constexpr int kDeepestPath = 10000;

}  // namespace orrery::scene
