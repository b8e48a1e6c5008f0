// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "scene/diagnostic.h"
#include "scene/forward.h"

namespace orrery::load {

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

}  // namespace orrery::load
