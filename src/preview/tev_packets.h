// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace orrery::preview {

/// A packet that makes tev create a black image with channels R, G and B, replacing one of the same name.
///
/// `grabs_focus`  tev selects the image
/// Reference  tev
std::string tev_create(const std::string& name, int width, int height, bool grabs_focus);

/// A packet that replaces a rectangle of an image.
///
/// `rgb`      3 * width * height scene-linear values, row by row from the top
/// Reference  tev
std::string tev_update(const std::string& name, int x, int y, int width, int height, const std::vector<float>& rgb);

}  // namespace orrery::preview
