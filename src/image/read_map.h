// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace orrery::image {

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

}  // namespace orrery::image
