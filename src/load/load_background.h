// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "load/load_map.h"
#include "scene/scene.h"

namespace orrery::load {

/// A background to read.
struct BackgroundRequest {
  std::filesystem::path file;
  std::string ocio_config;         ///< in the form of display::Settings
  std::uint64_t memory_limit = 0;  ///< bytes; 0: the free memory
  bool skips_large = false;        ///< an image that does not fit into memory is a warning and is not read
};

/// Reads the image of scene.background and converts it to the working space; see load_map.
///
/// Domain     the background is an image
/// Errors     those of the file and of colour spaces become diagnostics; base::Error(kNoMemory) if the image does not
///            fit into memory, before its pixels are read
LoadedBackground load_background(const BackgroundRequest& request, const scene::Scene& scene);

/// Identifies the file and the conversion: equal texts, equal results of load_background().
std::string background_version(const BackgroundRequest& request, const scene::Scene& scene);

/// Computes the sky of scene.background and converts it to the working space.
///
/// `ocio_config`  in the form of display::Settings
/// Domain         the background is a sky
/// Errors         an OCIO config without linear Rec.709, in which the sky is computed, becomes a diagnostic;
///                base::Error as for display::pixel_conversion
LoadedBackground load_sky(const std::string& ocio_config, const scene::Scene& scene);

}  // namespace orrery::load
