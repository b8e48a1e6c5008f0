// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "denoise/denoise.h"
#include "display/develop.h"
#include "display/settings.h"
#include "film/picture.h"
#include "image/rewrite.h"

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

/// Arguments of `orrery denoise`.
struct Denoising {
  std::filesystem::path input, output;  ///< EXR
  int threads = 0;                      ///< 0: all CPUs available to the process
};

/// Result of denoise_file().
struct DenoisedFile {
  denoise::Report report;
  image::RewriteReport written;
};

/// Filters the noise of an EXR. Its parts, other channels, pixel types and attributes are kept; the attribute
/// denoise::kAttribute is added.
///
/// Errors     base::Error of any kind; kUsage if the output is the input, or a file is not an EXR; kBadData if the
///            image has no R, G and B
DenoisedFile denoise_file(const Denoising& denoising);

}  // namespace orrery::job
