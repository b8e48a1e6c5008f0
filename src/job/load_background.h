// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scene/environment_image.h"
#include "scene/scene.h"
#include "scene/validate.h"

namespace orrery::job {

/// An image background that was read, and what was found out about its file; or a sky.
struct LoadedBackground {
  int width = 0, height = 0;  ///< texels
  std::string color_space;    ///< of the file or of the sky
  std::uint64_t bytes = 0;    ///< estimated memory of the texels and of the tables to sample them
  std::shared_ptr<const scene::EnvironmentImage> image;  ///< in the working space; null if it was not read
  std::vector<scene::SceneDiagnostic> diagnostics;       ///< errors and warnings, by key of the scene
};

/// The last background that was read, for the frames of a sequence. A file that has changed since is read again.
struct BackgroundCache {
  std::string key;  ///< of the file, its time and the conversion
  LoadedBackground loaded;
};

/// A background to read.
struct BackgroundRequest {
  std::filesystem::path file;
  std::string ocio_config;         ///< in the form of display::Settings
  std::uint64_t memory_limit = 0;  ///< bytes; 0: the free memory
  bool skips_large = false;        ///< an image that does not fit into memory is a warning and is not read
  std::shared_ptr<BackgroundCache> cache = nullptr;
};

/// Reads the image of scene.background and converts it to the working space. The file is in the space that it declares
/// (colorInteropID, chromaticities, or the name that OpenImageIO's tools write), else in that of
/// background.color_space, else in that of color.space.
///
/// NaN, infinite and negative values become 0 and are counted in a warning.
///
/// Domain     the background is an image
/// Errors     those of the file and of colour spaces become diagnostics; base::Error(kNoMemory) if the image does not
///            fit into memory, before its pixels are read
LoadedBackground load_background(const BackgroundRequest& request, const scene::Scene& scene);

/// Computes the sky of scene.background and converts it to the working space.
///
/// `ocio_config`  in the form of display::Settings
/// Domain         the background is a sky
/// Errors         an OCIO config without linear Rec.709, in which the sky is computed, becomes a diagnostic;
/// base::Error
///                as for display::pixel_conversion
LoadedBackground load_sky(const std::string& ocio_config, const scene::Scene& scene);

}  // namespace orrery::job
