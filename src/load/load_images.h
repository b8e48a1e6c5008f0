// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "scene/diagnostic.h"
#include "scene/lat_long_map.h"
#include "scene/scene.h"

/// Reads the images that a scene names, those of its background and of its textures: latitude-longitude maps, which are
/// converted to the working space. A file is in the space that it declares (colorInteropID, chromaticities, or the name
/// that OpenImageIO's tools write), else in that of the key `color_space`, else in sRGB for integers and in that of the
/// scene for scene-linear files.
///
/// NaN and negative values become 0, infinite ones the largest that the file can hold, and values that are too large
/// the largest; warnings state how many.
namespace orrery::load {

struct ImageRequest {
  std::filesystem::path folder;    ///< of the scene file, to which names of files are relative
  std::string ocio_config;         ///< in the form of display::Settings
  std::uint64_t memory_limit = 0;  ///< bytes, of an image or of all textures together; 0: the free memory
  bool skips_large = false;        ///< an image that does not fit into memory is a warning and is not read
};

/// The rest of a memory limit, at least one byte; 0 if there is no limit.
std::uint64_t rest_of(std::uint64_t limit, std::uint64_t used);

/// A map that was read, and the properties of its file.
struct LoadedMap {
  std::string version;        ///< identifies the contents of the file and the conversion; empty: unknown
  int width = 0, height = 0;  ///< texels
  std::string color_space;    ///< colour space of the file; empty for data
  std::uint64_t bytes = 0;    ///< estimated memory of the texels, and of their mip map or sampling tables
  std::shared_ptr<const scene::LatLongMap> image;   ///< in the working space; null if it was not read
  float brightest = 0;                              ///< largest value of `image`, including the sun
  std::vector<scene::SceneDiagnostic> diagnostics;  ///< errors and warnings, by key of the scene
};

/// Reads the image of scene.background.
///
/// Domain     the background is an image
/// Errors     those of the file and of colour spaces become diagnostics; base::Error(kNoMemory) if the image does not
///            fit into memory, before its pixels are read
LoadedMap load_background(const ImageRequest& request, const scene::Scene& scene);

/// Identifies the file and the conversion: equal texts, equal results of load_background().
std::string background_version(const ImageRequest& request, const scene::Scene& scene);

/// Computes the sky of scene.background and converts it to the working space.
///
/// `ocio_config`  in the form of display::Settings
/// Domain         the background is a sky
/// Errors         an OCIO config without linear Rec.709, in which the sky is computed, becomes a diagnostic;
///                base::Error as for display::pixel_conversion
LoadedMap load_sky(const std::string& ocio_config, const scene::Scene& scene);

/// An image texture that was read.
struct LoadedTexture {
  std::string key;  ///< "material.earth.albedo"
  LoadedMap map;
  bool is_shared = false;  ///< an earlier texture has the same image
};

/// Reads the files of all image textures, each once. Reflectances and numbers are clamped to 0..1.
///
/// `known`    textures of an earlier load; those whose files have not changed since are not read again
/// Result     in the order of scene::image_textures
/// Errors     as load_background()
std::vector<LoadedTexture> load_textures(const ImageRequest& request, const std::vector<LoadedTexture>& known,
                                         const scene::Scene& scene);

/// Assigns the images that load_textures() has read to the textures of a scene.
void set_textures(const std::vector<LoadedTexture>& loaded, scene::Scene& scene);

/// The OCIO config that a scene names, in the form of display::Settings; empty: none.
std::string config_of(const std::filesystem::path& scene_file, const scene::Color& color);

/// Converts all colours of a scene to its working space. Clamps reflectances to 0..1 and radiances to 0 or more.
///
/// `ocio`     OCIO config, in the form of display::Settings; not loaded if both spaces are the same
/// Result     number of clamped colours
/// Errors     those of display::pixel_conversion
int to_working_space(const std::string& ocio, scene::Scene& scene);

}  // namespace orrery::load
