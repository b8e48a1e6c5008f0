// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "kernel/path_stream.h"
#include "kernel/render_tile.h"
#include "kernel/scene_view.h"
#include "math/dispatch.h"

namespace orrery::kernel {
namespace {

constexpr int kWidth = 7, kHeight = 5;
constexpr std::uint32_t kSamples = 3;

/// Renders the white background, which all rays reach.
TileCounts render_background(Precision precision, bool records, std::vector<PixelSum>& sums) {
  const Sphere none{};
  SceneView scene;
  scene.spheres = &none;
  Tracer misses;
  misses.trace = [](const void*, void*, int) {};
  sums.assign(kWidth * kHeight, {});
  Tile tile;
  tile.width = kWidth;
  tile.row_stride = kWidth;
  tile.height = kHeight;
  tile.sample_end = kSamples;
  tile.sums = sums.data();
  return render_tile_function(scene.features, precision, records)(scene, misses, tile, *std::make_unique<PathStream>());
}

TEST(KernelTile, EachInstanceRendersEachSampleOnceWithTheChosenSet) {
  const std::int64_t all = math::target_choice().available();
  for (std::int64_t set = all & -all; set != 0 && set <= all; set <<= 1) {
    if ((all & set) == 0) continue;
    math::target_choice().limit(set);
    for (const Precision precision : {Precision::kExact, Precision::kFast, Precision::kBook})
      for (const bool records : {false, true}) {
        std::vector<PixelSum> sums;
        const TileCounts counts = render_background(precision, records, sums);
        EXPECT_EQ(counts.target, set);
        EXPECT_EQ(counts.rays, kWidth * kHeight * kSamples);
        for (const PixelSum& sum : sums) {
          EXPECT_EQ(sum.weight, kSamples);
          EXPECT_EQ(from_fixed_point(sum.rgb[0]), kSamples);
        }
      }
  }
  math::target_choice().limit(all);
}

}  // namespace
}  // namespace orrery::kernel
