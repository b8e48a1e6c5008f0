// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenImageIO/imageio.h>

#include <cstdint>
#include <string>

#include "image/checked_file.h"

namespace orrery::image {

/// Quality of JPEG files: what OpenImageIO calls "jpeg:95", without chroma subsampling.
inline constexpr int kJpegQuality = 95;

/// Encodes a picture as JPEG, byte for byte as OpenImageIO does, which ends the process at any error of libjpeg, such
/// as too little memory.
///
/// Domain     three channels of eight bits; a side of up to 65,500 px
/// Result     libjpeg's complaint, or nothing
std::string encode_jpeg(const OIIO::ImageSpec& spec, const std::uint8_t* pixels, CheckedFile& file);

}  // namespace orrery::image
