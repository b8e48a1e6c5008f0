// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "compile/environment.h"
#include "image/read.h"
#include "scene/diagnostic.h"
#include "scene/environment_image.h"
#include "scene/limits.h"

namespace orrery::load {

/// A latitude-longitude map to read: an image background or a texture.
struct MapRequest {
  std::filesystem::path file;
  std::string file_key, space_key;  ///< keys of the scene, for diagnostics
  image::MapFormats formats = image::MapFormats::kSceneLinear;
  std::string color_space;    ///< colour space that the scene assigns to the file; empty: none
  std::string default_space;  ///< default colour space of scene-linear files
  std::string working_space;  ///< colour space of the result
  bool is_color = true;       ///< false: data, which are not converted
  float largest = static_cast<float>(scene::kBrightestLight);  ///< values above are clamped
  std::string ocio_config;                                     ///< in the form of display::Settings
  compile::EnvironmentSampling sampling = {};  ///< sampling of the background for direct lighting; default: kNone
  bool has_mip_map = false;                    ///< add a mip map
  std::uint64_t memory_limit = 0;              ///< bytes; 0: the free memory
  bool skips_large = false;                    ///< an image that does not fit into memory is a warning and is not read
};

/// A map that was read, and the properties of its file.
struct LoadedMap {
  std::string version;        ///< identifies the contents of the file and the conversion; empty: unknown
  int width = 0, height = 0;  ///< texels
  std::string color_space;    ///< colour space of the file; empty for data
  std::uint64_t bytes = 0;    ///< estimated memory of the texels, and of their mip map or sampling tables
  std::shared_ptr<const scene::EnvironmentImage> image;  ///< in the working space; null if it was not read
  float brightest = 0;                                   ///< largest value of `image`, including the sun
  std::vector<scene::SceneDiagnostic> diagnostics;       ///< errors and warnings, by key of the scene
};

/// An image background that was read, or a sky.
using LoadedBackground = LoadedMap;

/// Reads a map and converts it to the working space. The file is in the space that it declares (colorInteropID,
/// chromaticities, or the name that OpenImageIO's tools write), else in that of `color_space`, else in sRGB for
/// integers and in `default_space` for scene-linear files.
///
/// NaN and negative values become 0, infinite ones the largest that the file can hold, and values above `largest`
/// become `largest`; warnings state how many.
///
/// Errors     those of the file and of colour spaces become diagnostics; base::Error(kNoMemory) if the image does not
///            fit into memory, before its pixels are read
LoadedMap load_map(const MapRequest& request);

}  // namespace orrery::load
