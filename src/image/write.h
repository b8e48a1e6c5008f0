// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "film/deep_picture.h"
#include "film/encoded_picture.h"
#include "film/picture.h"
#include "image/exr_options.h"
#include "image/library.h"

namespace orrery::image {

/// One attribute of our own, "orrery/seed".
struct Attribute {
  std::string name;
  std::variant<std::string, int, float> value;
};

/// The attribute that holds a header's stamp; formats that have no attributes of ours hold name and stamp as their
/// description, Radiance and PPM files nothing.
inline constexpr const char* kStampName = "orrery/stamp";

/// What stands in a picture's header beside its pixels. What is empty is left out; with a header that does not change
/// between runs, two writes give the same bytes.
struct Header {
  std::string software;
  std::string capture_date;                             ///< "YYYY:MM:DD hh:mm:ss", local time
  std::optional<std::array<int, 2>> frames_per_second;  ///< numerator, denominator
  /// 4x4, row vectors times matrix as OpenEXR has it; see docs/output.md.
  std::optional<std::array<float, 16>> world_to_camera, world_to_ndc;
  std::optional<float> focus;  ///< distance of what is sharp; scene units, which OpenEXR takes for metres
  std::optional<std::array<float, 8>> chromaticities;  ///< x, y of red, green, blue, white
  std::string color_interop_id;
  std::vector<Attribute> attributes;
  std::vector<Attribute>
      matte_attributes;    ///< Cryptomatte's; a file of several parts has them where the mattes are, too
  std::string stamp = {};  ///< names what the picture is made of; see kStampName
};

/// What had to be changed to fit into the file.
struct WriteReport {
  std::uint64_t clamped = 0;     ///< finite values that the file's numbers cannot hold, now the nearest that they can
  std::uint64_t not_finite = 0;  ///< NaN and infinities, now 0
};

/// Writes scene-linear planes as EXR, scanlines. Data are float whatever the options say; colours and vectors are half
/// unless asked for as float.
///
/// Result     the file stands under its name whole and synced, or an error is thrown and nothing has changed
/// Errors     base::Error: kUsage for an unknown compression or a lossy one
///            of data, kCannotCreate, kIo, kInternal for planes that do not fit
WriteReport write_exr(const std::filesystem::path& file, const film::Picture& picture, const Header& header,
                      const ExrOptions& options);

/// Writes a deep picture as EXR: Z, ZBack, R, G, B, A, all float, scanlines, zips. Its windows are those of `flat`.
///
/// Result     as write_exr
/// Errors     base::Error: kCannotCreate, kIo
void write_deep(const std::filesystem::path& file, const film::DeepPicture& deep, const film::Picture& flat,
                const Header& header);

/// Writes planes R, G, B as Radiance HDR, which has no negative values and shares one exponent in a pixel.
///
/// Result     as write_exr
/// Errors     base::Error: kBadData where a plane is missing, kCannotCreate, kIo
WriteReport write_hdr(const std::filesystem::path& file, const film::Picture& picture);

/// Writes a picture for a display, in the format of the file's extension; always the same bytes for the same picture.
///
/// Result     as write_exr
/// Errors     base::Error: kUsage where the format does not hold so many bits, kCannotCreate, kIo
void write_encoded(const std::filesystem::path& file, const film::EncodedPicture& picture, const std::string& software,
                   const std::string& stamp = {});

}  // namespace orrery::image
