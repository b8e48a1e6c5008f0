// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "denoise/denoise.h"
#include "image/rewrite.h"

namespace orrery::job {

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
