// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <string>

#include "math/vec3.h"

namespace orrery::display {

/// Converts RGB pixels in place. Thread-safe.
using PixelConversion = std::function<void(float* rgb, std::size_t pixels)>;

/// Returns the conversion of an image from its colour space, linear or encoded, to a scene-linear space. Empty if both
/// are the same, in which case no config is loaded.
///
/// Domain     `config_file` as Settings::config
/// Errors     those of choose; base::Error(kUsage) if the space to convert to is not scene-linear
PixelConversion pixel_conversion(const std::string& config_file, const std::string& from, const std::string& to);

/// Converts a colour; an empty conversion leaves it as it is.
math::Vec3d converted(const PixelConversion& convert, math::Vec3d color);

/// Primaries and white point of a scene-linear space with a Color Interop Forum id.
struct KnownSpace {
  const char* interop_id;               ///< "lin_rec709_scene"
  std::array<float, 8> chromaticities;  ///< x, y of red, green, blue, white
};

/// Looks up a scene-linear space by its name or alias. Null if orrery does not know it.
///
/// Reference  color-interop-forum
const KnownSpace* known_space(const std::string& name);

/// Looks up a scene-linear space by its primaries and white point. Null if orrery does not know it.
const KnownSpace* known_space(const std::array<float, 8>& chromaticities);

}  // namespace orrery::display
