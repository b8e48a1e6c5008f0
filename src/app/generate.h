// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

#include "scene/scene.h"

namespace orrery::app {

/// The random final scene of *Ray Tracing in One Weekend*: small spheres on a grid around three large ones.
struct FinalScene {
  std::uint64_t seed = 1;
  int grid = 11;  ///< cells from the middle to the edge: (2 grid)^2 small spheres, less those under a large one
};

/// The same seed gives the same scene on every machine.
///
/// Errors     base::Error(kUsage) for a grid outside of 0..1000
/// Reference  shirley2020, section "Where Next?", first figure
scene::Scene make_final_scene(const FinalScene& options);

/// A ball of small spheres of five materials on a ground, evenly filled at any count.
struct Cloud {
  std::uint64_t seed = 1;
  std::uint64_t count = 1000;
};

/// Errors     base::Error(kUsage) for a count outside of 1..100,000,000
scene::Scene make_cloud(const Cloud& options, const std::filesystem::path& points_file);

}  // namespace orrery::app
