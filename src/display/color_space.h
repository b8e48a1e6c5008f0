// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

namespace orrery::display {

/// Brings colours from one scene-linear space into another, in place.
///
/// `config_file` is as display::Settings has it.
///
/// Errors     base::Error: as choose; kUsage for a space that is not scene-linear
void convert_colors(const std::string& config_file, const std::string& from, const std::string& to,
                    std::vector<std::array<double, 3>>& colors);

/// Primaries and white of a scene-linear space that has a name of the Color Interop Forum.
struct KnownSpace {
  const char* interop_id;               ///< "lin_rec709_scene"
  std::array<float, 8> chromaticities;  ///< x, y of red, green, blue, white
};

/// The space behind a name that orrery knows; null for all others.
///
/// Reference  color-interop-forum
const KnownSpace* known_space(const std::string& name);

}  // namespace orrery::display
