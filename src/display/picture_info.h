// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "display/settings.h"

namespace orrery::display {

/// Properties of an image that is about to be rendered.
struct PictureInfo {
  std::string name;           ///< name of the scene file
  int width = 0, height = 0;  ///< px
  double pixel_aspect = 1;    ///< pixel width / height
  Settings display;           ///< from the command line and the scene
};

}  // namespace orrery::display
