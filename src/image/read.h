// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "film/picture.h"

namespace orrery::image {

enum class Parts { kFirst, kAll };

/// Reads all channels of an image file as float planes, in any format that this room writes.
///
/// Of a multi-part EXR, the first part is read, or all parts that have its display window; a channel whose name occurs
/// in an earlier part is then named PART.CHANNEL. The result covers the display window: a smaller data window is padded
/// with zeros, a larger one is cropped. Integers of display formats are scaled to 0..1 and stay display-encoded;
/// integers of EXR keep their values.
///
/// `memory_limit`  maximum size of the planes, bytes; 0: none. The whole display window takes memory, even where the
///                 file has no pixels
/// Errors          base::Error: kUsage for an unknown extension, kMissingInput if the file cannot be opened, kBadData
///                 if it is not of the format of its extension, truncated or too large, kNoMemory
film::Picture read(const std::filesystem::path& file, Parts parts = Parts::kFirst, std::uint64_t memory_limit = 0);

/// Accepted formats of a map.
enum class MapFormats {
  kSceneLinear,  ///< EXR and HDR: environment maps
  kAll,          ///< all formats that orrery writes: textures
};

/// Header of a latitude-longitude map.
struct MapHeader {
  int width = 0, height = 0;                             ///< size of the display window, px
  std::string color_interop_id = {};                     ///< "lin_ap1_scene"; empty: not declared
  std::optional<std::array<float, 8>> chromaticities{};  ///< x, y of red, green, blue, white
  std::string color_space = {};  ///< colour space as declared by OpenImageIO's tools; empty: not declared
  bool is_encoded = false;       ///< the file has a display format: values are not scene-linear
  bool is_padded = false;        ///< pixels of the display window without data are black
  bool is_half = false;          ///< values are in half precision, which cannot hold more than 65,504
};

/// Reads the header of an image file, without its pixels.
///
/// Errors     base::Error: kMissingInput if the file cannot be opened, kBadData if it is of another format, damaged or
///            too large, or has neither the channels R, G and B nor a single channel
MapHeader read_map_header(const std::filesystem::path& file, MapFormats formats = MapFormats::kSceneLinear);

/// Reads R, G and B of an image file row by row, from the top, without keeping them. Integers are scaled to 0..1.
///
/// `take`     called for each row of the display window with its width * 3 values, which it may modify. Rows and
///            columns outside the data window are zero. A single channel is used for all three.
/// Errors     as read_map_header; kBadData if the file is truncated
void read_map(const std::filesystem::path& file, const std::function<void(int row, float* rgb)>& take,
              MapFormats formats = MapFormats::kSceneLinear);

/// Decodes all pixels of all parts of an image file and returns its stamp (Header::stamp).
///
/// Result     empty if the file is missing, incomplete or has no stamp
std::string verified_stamp(const std::filesystem::path& file);

}  // namespace orrery::image
