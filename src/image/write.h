// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "film/forward.h"

namespace orrery::image {

struct ExrOptions;
struct Header;

/// Numbers of values that were changed to fit into the file.
struct WriteReport {
  std::uint64_t clamped = 0;     ///< finite values outside the range of the file's number type, clamped to it
  std::uint64_t not_finite = 0;  ///< NaN and infinities, written as 0
};

/// Writes scene-linear planes as a scanline EXR. Data planes are always float; colours and vectors are half unless
/// ExrOptions::as_float is set.
///
/// Result     the file is complete and synced, or an error is thrown and an existing file is unchanged
/// Errors     base::Error: kUsage for an unknown compression or a lossy one of data, kCannotCreate, kIo, kInternal for
///            planes of a wrong size
WriteReport write_exr(const std::filesystem::path& file, const film::Picture& picture, const Header& header,
                      const ExrOptions& options);

/// Writes a deep scanline EXR with float channels R, G, B, A, Z, ZBack and zips compression. Its windows are those of
/// `flat`.
///
/// Result     as for write_exr
/// Errors     base::Error: kCannotCreate, kIo
void write_deep(const std::filesystem::path& file, const film::DeepPicture& deep, const film::Picture& flat,
                const Header& header);

/// Writes planes R, G, B as Radiance HDR, a format without negative values and with a shared exponent per pixel.
///
/// Result     as for write_exr
/// Errors     base::Error: kBadData if a plane is missing, kCannotCreate, kIo
WriteReport write_hdr(const std::filesystem::path& file, const film::Picture& picture);

/// Writes a display-encoded image in the format of the file's extension. The same image gives the same bytes.
///
/// Result     as for write_exr
/// Errors     base::Error: kUsage if the format does not support the bit depth or size, kCannotCreate, kIo
void write_encoded(const std::filesystem::path& file, const film::EncodedPicture& picture, const std::string& software,
                   const std::string& stamp = {});

/// Compression levels of png_bytes(), those of zlib.
inline constexpr int kCompressed = 6, kUncompressed = 0;

/// Encodes a display-encoded image of 8 bits per channel as PNG in memory. Compression takes most of the time.
///
/// Errors     base::Error(kInternal): the encoder's
std::string png_bytes(const film::EncodedPicture& picture, int compression);

/// Quality of JPEG files: OpenImageIO's "jpeg:95", without chroma subsampling.
inline constexpr int kJpegQuality = 95;

/// Encodes an image as JPEG in memory, without metadata.
///
/// `codes`    R, G, B of all pixels, row by row from the top
/// `quality`  1 to 100; with chroma subsampling below kJpegQuality
/// Domain     a side of up to 65,500 px
/// Errors     base::Error(kInternal): libjpeg's
std::string jpeg_bytes(int width_px, int height_px, const std::uint8_t* codes, int quality);

}  // namespace orrery::image
