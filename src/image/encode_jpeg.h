// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenImageIO/imageio.h>

#include <cstdint>
#include <string>

#include "image/checked_file.h"

namespace orrery::image {

/// JPEG quality: OpenImageIO's "jpeg:95", without chroma subsampling.
inline constexpr int kJpegQuality = 95;

/// Encodes an image as JPEG with the same bytes as OpenImageIO, which exits the process on any libjpeg error, such as
/// lack of memory.
///
/// Domain     three channels of eight bits; a side of up to 65,500 px
/// Result     libjpeg's error message, or empty
std::string encode_jpeg(const OIIO::ImageSpec& spec, const std::uint8_t* pixels, CheckedFile& file);

}  // namespace orrery::image
