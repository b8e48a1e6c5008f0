// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "display/develop.h"
#include "film/picture.h"

namespace orrery::app {

/// What `orrery develop` was asked for.
struct Development {
  std::filesystem::path input;                 ///< scene-linear light
  std::vector<std::filesystem::path> outputs;  ///< display formats
  display::Settings display;                   ///< working space empty: what the picture says, else lin_rec709
  int bits = 0;                                ///< 0: 8
};

struct DevelopReport {
  film::BadValues bad_values;  ///< of the input's colours, before any display transform
  display::Choice display;
};

/// Develops a picture on disk for a display, into every output.
///
/// Errors     base::Error of every kind; kUsage for an output that is no display format, and for an input that is one
DevelopReport develop_file(const Development& development);

}  // namespace orrery::app
