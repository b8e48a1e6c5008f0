// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace orrery::display {

/// Converts colours from one scene-linear space to another, in place.
///
/// Domain     `config_file` as Settings::config
/// Errors     those of choose; base::Error(kUsage) for a space that is not scene-linear
void convert_colors(const std::string& config_file, const std::string& from, const std::string& to,
                    std::vector<std::array<double, 3>>& colors);

/// Converts RGB pixels in place. Thread-safe.
using PixelConversion = std::function<void(float* rgb, std::size_t pixels)>;

/// Returns the conversion of an image from its colour space, linear or encoded, to a scene-linear space. Empty if both
/// are the same, in which case no config is loaded.
///
/// Domain     `config_file` as Settings::config
/// Errors     as convert_colors
PixelConversion pixel_conversion(const std::string& config_file, const std::string& from, const std::string& to);

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
