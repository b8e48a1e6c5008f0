// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace orrery::image {

/// A custom attribute, e.g. "orrery/seed".
struct Attribute {
  std::string name;
  std::variant<std::string, int, float> value;
};

/// The attribute that holds a header's stamp. Formats without custom attributes hold this name and the stamp in their
/// description; Radiance, PPM and SVG files hold no stamp.
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
  double dpi = 0;          ///< px per inch in print, of display formats; 0: not known
  std::string stamp = {};  ///< hash of everything that determines the image; see kStampName
};

/// Origin of a checkpoint or shard as name-value pairs, e.g. "sceneHash" = "0123456789abcdef".
using Provenance = std::map<std::string, std::string>;

}  // namespace orrery::image
