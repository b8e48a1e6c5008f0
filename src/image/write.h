// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "film/picture.h"
#include "image/exr_options.h"
#include "image/library.h"

namespace orrery::image {

/// A custom attribute, e.g. "orrery/seed".
struct Attribute {
  std::string name;
  std::variant<std::string, int, float> value;
};

/// The attribute that holds a header's stamp. Formats without custom attributes hold this name and the stamp in their
/// description; Radiance and PPM files hold no stamp.
inline constexpr const char* kStampName = "orrery/stamp";

/// Metadata of an image. Empty members are not written. The same pixels with the same header give the same bytes.
struct Header {
  std::string software;
  std::string capture_date;                             ///< "YYYY:MM:DD hh:mm:ss", local time
  float utc_offset_s = 0;                               ///< UTC - local time, seconds
  std::optional<std::array<int, 2>> frames_per_second;  ///< numerator, denominator
  /// 4x4, row vector times matrix as in OpenEXR; see docs/output.md.
  std::optional<std::array<float, 16>> world_to_camera, world_to_ndc;
  std::optional<float> focus;                          ///< focus distance; scene units, which OpenEXR defines as metres
  std::optional<std::array<float, 8>> chromaticities;  ///< x, y of red, green, blue, white
  std::string color_interop_id;
  std::vector<Attribute> attributes;
  std::vector<Attribute>
      matte_attributes;    ///< Cryptomatte metadata; written to the first part and to the parts of the mattes
  std::string stamp = {};  ///< hash of everything that determines the image; see kStampName
};

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

/// Writes planes R, G, B as Radiance HDR, which has no negative values and one shared exponent per pixel.
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

}  // namespace orrery::image
