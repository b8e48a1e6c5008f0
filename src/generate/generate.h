// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "scene/scene.h"

namespace orrery::generate {

/// Largest FinalScene::grid: four million small spheres.
inline constexpr int kLargestFinalGrid = 1000;

/// Largest grid whose small spheres are written one by one, each with a material of its own. Beyond it the scene file
/// would be larger than an editor likes: spheres go to a points file and share a palette of kFinalPaletteSize
/// materials.
inline constexpr int kLargestWrittenGrid = 32;
inline constexpr std::uint32_t kFinalPaletteSize = 1024;

/// The random final scene of *Ray Tracing in One Weekend*: small spheres on a grid around three large ones.
struct FinalScene {
  std::uint64_t seed = 1;
  int grid = 11;  ///< cells from the middle to the edge: (2 grid)^2 small spheres, less those inside a large one
};

/// Three large spheres among many small ones on a huge ground; of the small ones four fifths are diffuse, three
/// twentieths metal, the rest glass. The same seed gives the same scene on every machine. Random numbers are rounded to
/// four decimals, which a person can read.
///
/// Units      scene units, degrees
/// Result     `spheres`: the ground, the small ones up to kLargestWrittenGrid, the three large ones; beyond that grid
///            the small ones are `points[0]`
/// Errors     base::Error(kUsage) for a grid outside 0..kLargestFinalGrid
/// Reference  shirley2024, "A Final Render"
scene::Scene make_final_scene(const FinalScene& options, const std::filesystem::path& points_file = "final.ply");

/// Largest Cloud::count; its points file has 3.6 GB.
inline constexpr std::uint64_t kLargestCloud = 100'000'000;

/// Largest Cloud::radius, scene units: beyond this the cloud is one ball with the camera inside.
inline constexpr double kLargestCloudRadius = 1;

/// A cloud of small spheres in the sky: something to look at, and to measure, at any size.
struct Cloud {
  std::uint64_t seed = 1;
  std::uint64_t count = 1000;
  std::optional<double> radius = {};  ///< scene units, of every sphere; default: by `count`, and varied
};

/// Without a given radius the cross-sections of all spheres sum up to the same whatever their number: a few make a heap
/// of balls, thousands a swarm, millions a mist, and the cloud lets about as much sky through each time.
///
/// Units      scene units; the cloud is about 4 wide
/// Result     `points[0]` holds exactly `count` spheres of four materials; there are no others
/// Errors     base::Error(kUsage) for a count outside 1..kLargestCloud, or a radius outside
///            scene::kSmallestRadius..kLargestCloudRadius
/// Cost       36 bytes a sphere
scene::Scene make_cloud(const Cloud& options, const std::filesystem::path& points_file = "cloud.ply");

}  // namespace orrery::generate
