// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "scene/scene.h"

namespace orrery::plot {

/// Options for reading a data file, common to all commands that turn particles into spheres.
struct DataOptions {
  std::filesystem::path file;  ///< data file, may contain a frame pattern
  std::vector<int> frames;     ///< empty: one frame
  bool all_frames = false;     ///< all frames of the file
  scene::Points points;        ///< keys that the user has set; `file` and the spheres are not used
  std::string color_by;        ///< "element", "type", "rgb", "none" or a column; empty: not set
  bool has_map = false;        ///< the user set `points.color.map`
  /// Slice planes: axis 0, 1 or 2, and position. Spheres in front of any of them are removed.
  std::vector<std::pair<int, double>> slices = {};
  std::uint64_t memory_limit = 0;  ///< bytes; 0: no limit
};

}  // namespace orrery::plot
