// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdint>

#include "denoise/tile_filter.h"
#include "math/dispatch.h"

namespace orrery::denoise {
namespace {

/// The first tile of an image with a step, filtered with weights from itself.
TilePixels filtered_step() {
  PaddedPlane plane(kTileWidth, kTileHeight), valid(kTileWidth, kTileHeight), variance(kTileWidth, kTileHeight);
  for (int y = 0; y < kTileHeight; ++y)
    for (int x = 0; x < kTileWidth; ++x) {
      *plane.at(x, y) = static_cast<float>(x > y) + 0.01F * static_cast<float>((3 * x + 5 * y) % 7);
      *valid.at(x, y) = 1;
      *variance.at(x, y) = 0.02F;
    }
  WeightSource source;
  source.compared = {{&plane, &plane}};
  source.variance = &variance;
  source.valid = &valid;
  source.radius = 2;
  source.target = {&plane, &plane, &plane};
  Worker worker;
  compute_weights(source, 0, 0, worker.scratch, worker.weights);
  apply_weights(worker.weights, source.radius, plane, 0, 0, worker.pixels);
  return worker.pixels;
}

TEST(DenoiseInstances, EverySetFiltersAlike) {
  const std::int64_t all = math::target_choice().available();
  const TilePixels best = filtered_step();
  EXPECT_LT(best[0], 0.1F) << "of the lower side of the step";
  EXPECT_GT(best[kTileWidth - 1], 0.9F);
  for (std::int64_t set = all & -all; set != 0 && set <= all; set <<= 1) {
    if ((all & set) == 0) continue;
    math::target_choice().limit(set);
    EXPECT_EQ(filtered_step(), best);
  }
  math::target_choice().limit(all);
}

}  // namespace
}  // namespace orrery::denoise
