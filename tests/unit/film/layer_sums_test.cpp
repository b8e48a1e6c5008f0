// SPDX-License-Identifier: Apache-2.0
#include "film/layer_sums.h"

#include <cstdint>
#include <limits>

#include "unit/film/pixel_of_layers.h"

namespace orrery::film {
namespace {

using FilmLayerSums = PixelOfLayers;

/// Shards have sums of the same paths in two pixels.
TEST_F(FilmLayerSums, MergedPixelsAddTheirLight) {
  request_.light_groups = true;
  request_.groups = {{"a", true, true}, {"b", true, true}};
  const kernel::PathRecord path = path_to(0, 0.5);
  add(path, {{{0.5, 0.5, 0.5}, 0, 1, kernel::Lobe::kEmission}});
  const Sums first = sums();
  clear();
  sums().add(first);  // a pixel that this shard does not own
  add(path, {{{0.5, 0.5, 0.5}, 0, 0, kernel::Lobe::kDiffuseDirect}});
  sums().add(Sums(1, 1, request_));
  EXPECT_EQ(value(picture(), "b_emission.R"), 0.25F);
  EXPECT_EQ(value(picture(), "a.G"), 0.25F);
}

TEST_F(FilmLayerSums, InvalidRadianceIsIgnored) {
  request_.diffuse = request_.samples = request_.albedo = true;
  add(path_to(0, 0.5));
  add(path_to(0, std::numeric_limits<double>::quiet_NaN()));
  add(path_to(0, 1e30));
  const Picture p = picture();
  EXPECT_EQ(value(p, "diffuse_direct.R"), 0.5F);
  EXPECT_EQ(value(p, "samples.X"), 1);
  EXPECT_EQ(value(p, "albedo.R"), 1);  // the hits count nevertheless
}

/// Squares below 2^14 are converted in 64 bits, others in two steps.
/// Up to kLargestSquare.
TEST_F(FilmLayerSums, SquaresAreExact) {
  request_.variance = true;
  for (const std::int64_t light : {1LL, 127LL, 128LL, 129LL, 200LL, 1LL << 20, 11'863'283LL}) {
    clear();
    add(path_to(0, static_cast<double>(light)));
    EXPECT_TRUE(sums().layers.squares[0][0] == static_cast<kernel::Int128>(light * light) << 48) << light;
  }
}

/// All that two halves of the maximum number of samples can add up to fits into the sums.
TEST_F(FilmLayerSums, SumsHoldTheMaximumCountOfTheBrightestPaths) {
  request_.variance = request_.diffuse = true;
  const auto twice = [&] { sums().add(Sums(sums())); };
  for (int bit = 0; bit < 31; ++bit) {
    twice();
    add(path_to(0, kernel::kLargestSample));
  }
  twice();
  EXPECT_EQ(beauty().weight, 2 * ((1U << 31) - 1));
  const Picture p = picture();
  EXPECT_EQ(value(p, "diffuse_direct.R"), 0x1p35F);
  EXPECT_EQ(mean(beauty().rgb[0], beauty().weight), 0x1p35);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_TRUE(sums().layers.squares[0][c] > 0) << "overflow";
}

}  // namespace
}  // namespace orrery::film
