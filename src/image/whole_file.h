// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <OpenImageIO/imageio.h>

namespace orrery::image {

class CheckedFile;

/// One part of an image file. All parts of a file have the same size.
struct WholePart {
  OIIO::ImageSpec spec;
  const void* pixels = nullptr;             ///< spec's width x height x channels values, rows from the top
  const OIIO::DeepData* deep = nullptr;     ///< replaces `pixels` if spec.deep is set
  std::optional<OIIO::TypeDesc> type = {};  ///< type of `pixels` if it differs from that of the other parts
};

/// Writes an image file with OpenImageIO: to a temporary file with every write checked, read back, synced and renamed.
/// A part without the attribute DateTime gets none: the same parts give the same bytes at any time.
///
/// Domain     `format` is OpenImageIO's format name; `type` is the type of the pixels; more than one part only if the
///            format supports it; `with_digest` appends a digest
/// Errors     base::Error: kCannotCreate, kIo; an existing file is then unchanged
void write_whole(const std::filesystem::path& file, const std::string& format, OIIO::TypeDesc type,
                 const std::vector<WholePart>& parts, bool with_digest = false);

/// Checks the digest of a file.
///
/// Errors     base::Error: kMissingInput if the file cannot be opened, kBadData if it has no digest or a wrong one
void require_digest(const std::filesystem::path& file);

/// Encodes an image as JPEG with the same bytes as OpenImageIO, which exits the process on any libjpeg error, such as
/// lack of memory.
///
/// Domain     three channels of eight bits; a side of up to 65,500 px
/// Result     libjpeg's error message, or empty
std::string encode_jpeg(const OIIO::ImageSpec& spec, const std::uint8_t* pixels, CheckedFile& file);

}  // namespace orrery::image
