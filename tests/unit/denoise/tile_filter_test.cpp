// SPDX-License-Identifier: Apache-2.0
#include "denoise/tile_filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace orrery::denoise {
namespace {

constexpr int kSide = 24;

/// A plane of f(x, y); 0 outside of the image.
template <class F>
PaddedPlane plane_of(F f) {
  PaddedPlane out(kSide, kSide);
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) *out.at(x, y) = f(x, y);
  return out;
}

/// The plane filtered with weights from itself, in a window of radius 2.
std::vector<float> filtered(const PaddedPlane& plane, float variance, const PaddedPlane& valid) {
  const PaddedPlane variances = plane_of([=](int, int) { return variance; });
  WeightSource source;
  source.compared = {{&plane, &plane}};
  source.variance = &variances;
  source.valid = &valid;
  source.radius = 2;
  source.target = {&plane, &plane, &plane};
  Tiles tiles(Frame{kSide, kSide});
  std::vector<float> out(kSide * kSide);
  tiles.each([&](Worker& worker, int x0, int y0) {
    compute_weights(source, x0, y0, worker.scratch, worker.weights);
    apply_weights(worker.weights, source.radius, plane, x0, y0, worker.pixels);
    tiles.each_pixel(
        x0, y0, [&](std::size_t i, int x, int y) { out[static_cast<std::size_t>(y * kSide + x)] = worker.pixels[i]; });
  });
  return out;
}

TEST(DenoiseTileFilter, WeightsAddUpToOne) {
  const PaddedPlane all = plane_of([](int, int) { return 1.0F; });
  for (const float v : filtered(plane_of([](int, int) { return 0.7F; }), 0.1F, all)) EXPECT_NEAR(v, 0.7F, 1e-6);
}

TEST(DenoiseTileFilter, AnEdgeBeyondTheNoiseIsKeptAndNoiseIsAveraged) {
  const PaddedPlane all = plane_of([](int, int) { return 1.0F; });
  const auto checks = [](int x, int y) { return (x + y) % 2 == 0 ? 0.01F : -0.01F; };
  const PaddedPlane plane = plane_of([&](int x, int y) { return (x < kSide / 2 ? 0.0F : 1.0F) + checks(x, y); });
  const std::vector<float> out = filtered(plane, 0.01F, all);
  for (int y = 4; y < kSide - 4; ++y)
    for (int x = 4; x < kSide - 4; ++x)
      EXPECT_NEAR(out[static_cast<std::size_t>(y * kSide + x)], x < kSide / 2 ? 0 : 1, 0.005) << x << " " << y;
}

TEST(DenoiseTileFilter, InvalidPixelsHaveNoWeight) {
  const PaddedPlane some = plane_of([](int x, int) { return x == 5 ? 0.0F : 1.0F; });
  const PaddedPlane plane = plane_of([](int x, int) { return x == 5 ? 0.9F : 0.7F; });
  const std::vector<float> out = filtered(plane, 100, some);
  for (int x = 0; x < kSide; ++x) EXPECT_NEAR(out[static_cast<std::size_t>(10 * kSide + x)], 0.7F, 1e-6) << x;
}

}  // namespace
}  // namespace orrery::denoise
