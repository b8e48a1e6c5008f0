// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "scene/scene.h"

namespace orrery::generate {

/// Maximum FinalScene::grid: four million small spheres.
inline constexpr int kLargestFinalGrid = 1000;

/// Maximum grid whose small spheres are written as [[sphere]] tables, each with its own material. Above it, the scene
/// file would be too large for editors: spheres go to a points file and share a palette of kFinalPaletteSize materials.
inline constexpr int kLargestWrittenGrid = 32;
inline constexpr std::uint32_t kFinalPaletteSize = 1024;

/// The random final scene of *Ray Tracing in One Weekend*: small spheres on a grid around three large ones.
struct FinalScene {
  std::uint64_t seed = 1;
  int grid = 11;  ///< cells from the centre to the edge: (2 grid)^2 small spheres, minus those near the large metal one
};

/// Returns the scene: three large spheres among many small ones on a huge ground sphere. Of the small spheres, 80 % are
/// diffuse, 15 % metal and 5 % glass. The same seed gives the same scene on every machine.
///
/// Result     `spheres`: the ground, the small ones, the three large ones; the small ones are in `points[0]` instead if
///            `grid` exceeds kLargestWrittenGrid
/// Domain     a grid in 0..kLargestFinalGrid
/// Reference  shirley2024, "A Final Render"
scene::Scene make_final_scene(const FinalScene& options, const std::filesystem::path& points_file = "final.ply");

/// Maximum Cloud::count; the points file is then 3.6 GB large.
inline constexpr std::uint64_t kLargestCloud = 100'000'000;

/// Maximum Cloud::radius, scene units: above it, the cloud is a single ball that contains the camera.
inline constexpr double kLargestCloudRadius = 1;

/// A cloud of small spheres in the sky, of any size, for images and benchmarks.
struct Cloud {
  std::uint64_t seed = 1;
  std::uint64_t count = 1000;
  /// Scene units, of every sphere; default: random, with a mean that depends on `count`.
  std::optional<double> radius = {};
};

/// Returns the scene of a cloud, about 4 wide. By default, the total cross-section does not depend on the number of
/// spheres: a few form a heap of balls, millions a mist, and about as much sky shows through.
///
/// Result     `points[0]` holds exactly `count` spheres of four materials; there are no others
/// Domain     a count in 1..kLargestCloud, and a radius in scene::kSmallestRadius..kLargestCloudRadius
/// Cost       36 bytes per sphere
scene::Scene make_cloud(const Cloud& options, const std::filesystem::path& points_file = "cloud.ply");

/// Writes a generated scene: TOML to `file`, points to a file of the same name with the extension .ply.
///
/// A comment at the top describes the scene and gives the command that reproduces it, byte for byte. An existing points
/// file is replaced only if orrery wrote it.
///
/// `force`    replace a scene file that orrery did not write, or that was edited since
/// Errors     base::Error: kUsage for options out of range and for a `file` that ends in .ply; kCannotCreate, before
///            anything is generated, including for files that must not be replaced; kIo
void generate_final(const FinalScene& options, const std::filesystem::path& file, bool force = false);
void generate_cloud(const Cloud& options, const std::filesystem::path& file, bool force = false);

}  // namespace orrery::generate
