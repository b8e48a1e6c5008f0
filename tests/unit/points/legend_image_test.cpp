// SPDX-License-Identifier: Apache-2.0
#include "points/legend.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace orrery::points {
namespace {

constexpr Srgb8 kBlack = {0, 0, 0}, kWhite = {255, 255, 255}, kRed = {255, 0, 0}, kBlue = {0, 0, 255};

Srgb8 at(const LegendImage& image, int x, int y) {
  return image
      .pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x)];
}

/// A rectangle as text: every second pixel, black as #.
std::string drawn(const LegendImage& image, int x, int y, int width, int height) {
  std::string out;
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) out += at(image, x + 2 * column, y + 2 * row) == kBlack ? '#' : '.';
    out += '\n';
  }
  return out;
}

TEST(PointsLegendImage, PatchesHaveLabels) {
  Legend legend;
  legend.patches = {{"1e", kRed}, {"C", kBlue}};
  legend.nan_color = Srgb8{188, 188, 188};
  const LegendImage image = legend_image(legend);
  EXPECT_EQ(image.pixels.size(), static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
  EXPECT_EQ(at(image, 0, 0), kWhite);
  EXPECT_EQ(at(image, 16, 16), kRed);
  EXPECT_EQ(at(image, 39, 39), kRed);
  EXPECT_EQ(at(image, 40, 40), kBlack) << "the border";
  EXPECT_EQ(at(image, 20, 60), kBlue);
  EXPECT_EQ(at(image, 20, 94), (Srgb8{188, 188, 188})) << "no value";
  EXPECT_EQ(image.height, 16 + 2 * 34 + 24 + 16);
  EXPECT_EQ(drawn(image, 48, 21, 11, 7),
            "..#........\n"
            ".##........\n"
            "..#....###.\n"
            "..#...#...#\n"
            "..#...#####\n"
            "..#...#....\n"
            ".###...###.\n");
}

TEST(PointsLegendImage, TicksAreAtTheirColors) {
  Legend legend;
  legend.bar = {kBlue, kRed};
  legend.first = 0;
  legend.last = 10;
  const LegendImage image = legend_image(legend);
  EXPECT_EQ(at(image, 20, 16), kRed) << "the last value at the top";
  EXPECT_EQ(at(image, 20, 16 + 511), kBlue);
  int ticks = 0;
  for (int y = 16; y < 16 + 512; ++y) ticks += at(image, 16 + 48 + 4, y) == kBlack;
  EXPECT_EQ(ticks, 11) << "0 to 10 in steps of 1";
  EXPECT_EQ(at(image, 16 + 48 + 4, 16), kBlack) << "10 is at the top";
  EXPECT_EQ(at(image, 16 + 48 + 4, 16 + 511), kBlack) << "0 is at the bottom";
}

TEST(PointsLegendImage, AnyTextAndAnyRangeIsDrawn) {
  Legend legend;
  legend.title = "v\xc3\xa4lue \xff \n " + std::string(1000, 'M');
  legend.bar = {kBlue};
  legend.first = -1e308;
  legend.last = 1e308;
  for (std::size_t i = 0; i < kMaxImagePatches; ++i) legend.patches.push_back({std::string(i, '~'), kRed});
  const LegendImage image = legend_image(legend);
  EXPECT_LT(image.width, 1000) << "long texts are truncated";
  EXPECT_EQ(std::count(image.pixels.begin(), image.pixels.end(), kBlue), 48 * 512);
  const LegendImage empty = legend_image({});
  EXPECT_EQ(empty.pixels.size(), static_cast<std::size_t>(empty.width) * static_cast<std::size_t>(empty.height));
}

}  // namespace
}  // namespace orrery::points
