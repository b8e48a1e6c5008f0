// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include <OpenImageIO/imageio.h>

#include "image/format.h"

namespace orrery::image {

/// Throws base::Error(kBadData) for an image that cannot be read.
[[noreturn]] void fail_to_read(const std::filesystem::path& file, const std::string& reason);

/// Throws base::Error(kNoMemory) for an image whose pixels do not fit into memory.
[[noreturn]] void fail_for_memory(const std::filesystem::path& file);

/// Checks the size in the header of an image or part.
///
/// Errors     base::Error(kBadData) if it is out of range or the pixels are deep
void check_spec(const std::filesystem::path& file, const OIIO::ImageSpec& spec);

/// An open image file, and one part of it.
struct Input {
  std::unique_ptr<OIIO::ImageInput> in;
  OIIO::ImageSpec spec;
  int part = 0;

  /// Number of rows to decode at a time.
  int row_step() const;
  /// Decodes rows begin..end of a channel range; false if that fails.
  bool decode(int begin, int end, int first_channel, int end_channel, OIIO::TypeDesc type, void* out) const;
  /// Decodes rows begin..end of all channels, which may be deep, and drops the values; false if that fails.
  bool can_decode(int begin, int end) const;
  /// The reason why decoding failed.
  std::string error_message() const;
};

/// How to read colours that a file stores with unassociated alpha, as PNG does.
enum class Alpha { kPremultiplied, kAsInFile };

/// Opens an image and checks its header.
///
/// Errors     as read()
Input open_input(const std::filesystem::path& file, Alpha alpha = Alpha::kPremultiplied);

/// Looks for damage that the libraries do not report, or report on standard error: PNG files that are truncated or
/// whose checksums do not match, and truncated JPEG files, whose missing rows libjpeg fills with grey. Pixels are not
/// decoded.
///
/// Result     what is wrong; empty if nothing was found, for other formats, and for a file whose format does not match
///            its name
std::string damage_of(const std::filesystem::path& file, Format format);

}  // namespace orrery::image
