// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace orrery::image {

/// Encodes an image as JPEG in memory, with chroma subsampling and without metadata.
///
/// `codes`    R, G, B of all pixels, row by row from the top
/// `quality`  1 to 100
/// Domain     a side of up to 65,500 px
/// Errors     base::Error(kInternal): libjpeg's
std::string jpeg_bytes(int width_px, int height_px, const std::uint8_t* codes, int quality);

}  // namespace orrery::image
