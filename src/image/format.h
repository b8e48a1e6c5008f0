// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "film/forward.h"

namespace orrery::image {

/// An image file format.
enum class Format {
  kExr,   ///< scene-linear, half or float
  kHdr,   ///< Radiance, scene-linear
  kPng,   ///< display, 8 or 16 bit
  kTiff,  ///< display, 8 or 16 bit
  kJpeg,  ///< display, 8 bit
  kPpm,   ///< display, 8 bit
  kSvg,   ///< display, 8 bit: a PNG below text and bars; only job::DisplayWriter writes it, nothing reads it
};

/// Properties of an image file format.
struct FormatInfo {
  Format format;
  std::vector<const char*> extensions;  ///< lower case, without the dot
  const char* library_name;             ///< OpenImageIO's name; empty: it does not know the format
  int largest_side;                     ///< px, that the encoder accepts
  bool is_display;                      ///< holds display-encoded colours; the others hold scene-linear values
  int max_bits;                         ///< of display formats: maximum number of bits per channel
  bool holds_alpha;                     ///< of display formats
  /// Estimated size of an image, which is noise in the worst case: bytes per pixel with up to 8 bits per channel, and
  /// with 16. 0: depends on the image (EXR).
  double bytes_per_pixel, bytes_per_pixel_16;
};

/// Returns the properties of a format.
const FormatInfo& info_of(Format format);

/// Returns the format that a file's extension selects, ignoring case.
///
/// Errors     base::Error(kUsage) listing the known extensions
Format format_of(const std::filesystem::path& file);

/// Whether a format holds display-encoded colours. The others hold scene-linear values without a display transform.
inline bool is_display_format(Format format) { return info_of(format).is_display; }

/// Whether a display format has a channel for alpha.
inline bool holds_alpha(Format format) { return info_of(format).holds_alpha; }

/// The maximum number of bits per channel of a display format.
inline int max_bits(Format format) { return info_of(format).max_bits; }

/// Checks before rendering that the format of a file supports this image size.
///
/// Errors     base::Error(kUsage) with the limit
void check_size(const std::filesystem::path& file, int width_px, int height_px);

struct ExrOptions {
  bool as_float = false;             ///< store colours and vectors as float instead of half
  std::string compression = "zips";  ///< a name that check_compression() accepts
  bool multipart = false;            ///< write one part per layer instead of a single part
};

/// Whether a compression is lossy.
///
/// Domain     a name that check_compression accepts
bool is_lossy(const std::string& compression);

/// Checks the name of an EXR compression before rendering: none, rle, zip, zips, piz, dwaa or dwab. The last two accept
/// a level, e.g. dwaa:45.
///
/// Errors     base::Error(kUsage) with the known names
void check_compression(const std::string& name);

/// Refuses a lossy compression of mattes and other data layers. Multi-part files are accepted, since their data parts
/// are compressed without loss.
///
/// Errors     base::Error(kUsage) with the remedy
void check_lossless(const std::vector<film::Plane>& planes, const ExrOptions& options);

}  // namespace orrery::image
