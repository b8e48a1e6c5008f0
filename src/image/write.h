// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "film/encoded_picture.h"
#include "film/picture.h"

namespace orrery::image {

/// One attribute of our own, "orrery/seed".
struct Attribute {
  std::string name;
  std::variant<std::string, int, float> value;
};

/// What stands in a picture's header beside its pixels. What is empty is left out.
struct Header {
  std::string software;
  std::string capture_date;  ///< "YYYY:MM:DD hh:mm:ss", local time
  /// 4x4, row vectors times matrix as OpenEXR has it; see docs/output.md.
  std::optional<std::array<float, 16>> world_to_camera, world_to_ndc;
  std::optional<std::array<float, 8>> chromaticities;  ///< x, y of red, green, blue, white
  std::string color_interop_id;
  std::vector<Attribute> attributes;
};

struct ExrOptions {
  bool as_float = false;            ///< half otherwise
  std::string compression = "zips";  ///< none, zip, zips, piz, dwaa:LEVEL
};

/// What had to be changed to fit into the file.
struct WriteReport {
  std::uint64_t clamped = 0;     ///< finite values beyond the largest half, now that
  std::uint64_t not_finite = 0;  ///< now 0
};

/// Writes scene-linear planes as EXR: one part, scanlines, display window and data window the whole frame.
///
/// Result     the file stands under its name whole and synced, or an error is thrown and nothing has changed
/// Errors     base::Error: kUsage for an unknown compression, kCannotCreate, kIo
WriteReport write_exr(const std::filesystem::path& file, const film::Picture& picture, const Header& header,
                      const ExrOptions& options);

/// Writes planes R, G, B as Radiance HDR.
WriteReport write_hdr(const std::filesystem::path& file, const film::Picture& picture);

/// Writes a picture for a display, in the format of the file's extension.
///
/// Errors     as write_exr; kUsage where the format does not hold so many bits
void write_encoded(const std::filesystem::path& file, const film::EncodedPicture& picture, const std::string& software);

/// The version of OpenImageIO that is loaded.
std::string oiio_version();

}  // namespace orrery::image
