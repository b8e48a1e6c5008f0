// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace orrery::image {

/// An image file format.
enum class Format {
  kExr,   ///< scene-linear, half or float
  kHdr,   ///< Radiance, scene-linear
  kPng,   ///< display, 8 or 16 bit
  kTiff,  ///< display, 8 or 16 bit
  kJpeg,  ///< display, 8 bit
  kPpm,   ///< display, 8 bit
};

/// The format of a file by its extension, regardless of case.
///
/// Errors     base::Error(kUsage) listing the known extensions
Format format_of(const std::filesystem::path& file);

/// Whether a format holds display-encoded colours. The others hold scene-linear values without a display transform.
bool is_display_format(Format format);

/// Whether a display format has a channel for alpha.
bool holds_alpha(Format format);

/// Checks before rendering that the format of a file supports this image size.
///
/// Errors     base::Error(kUsage) with the limit
void check_size(const std::filesystem::path& file, int width_px, int height_px);

/// The maximum number of bits per channel of a display format.
int max_bits(Format format);

}  // namespace orrery::image
