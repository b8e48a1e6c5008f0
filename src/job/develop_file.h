// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "display/develop.h"
#include "display/settings.h"
#include "film/picture.h"

namespace orrery::job {

/// Arguments of `orrery develop`.
struct Development {
  std::filesystem::path input;                 ///< scene-linear image
  std::vector<std::filesystem::path> outputs;  ///< files of display formats
  display::Settings display;  ///< if the working space is empty, that of the image is used, else lin_rec709
  int bits = 0;               ///< 0: the display's default
};

/// Result of develop_file().
struct DevelopReport {
  film::BadValues bad_values;  ///< invalid values of the input's colours
  display::Choice display;
};

/// Develops an image file for a display and writes all outputs.
///
/// Errors     base::Error of any kind; kUsage if an output is not in a display format, or the input is
DevelopReport develop_file(const Development& development);

}  // namespace orrery::job
