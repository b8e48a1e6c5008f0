// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace orrery::image {

/// What a file's extension asks for.
enum class Format {
  kExr,   ///< scene-linear, half or float
  kHdr,   ///< Radiance, scene-linear
  kPng,   ///< display, 8 or 16 bit
  kTiff,  ///< display, 8 or 16 bit
  kJpeg,  ///< display, 8 bit
  kPpm,   ///< display, 8 bit
};

/// The format of a file name.
///
/// Errors     base::Error(kUsage) listing the known extensions
Format format_of(const std::filesystem::path& file);

/// Whether a format shows colours as a display does; the others hold scene-linear light and never see a display
/// transform.
bool is_display_format(Format format);

/// Whether a display format has a channel for alpha.
bool holds_alpha(Format format);

/// Checks that the format of a file takes a picture of this size, before there is one: an encoder that finds out later
/// costs a render, or the process.
///
/// Errors     base::Error(kUsage) with the limit
void check_size(const std::filesystem::path& file, int width_px, int height_px);

/// The most bits that a display format holds in a channel.
int most_bits(Format format);

}  // namespace orrery::image
