// SPDX-License-Identifier: Apache-2.0
#include "preview/graphics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <vector>

#include "unit/preview/drawings.h"
#include "unit/preview/pictures.h"
#include "unit/preview/png_bytes.h"

namespace orrery::preview {
namespace {

/// Largest difference of two bitmaps' codes.
int largest_difference(const Bitmap& a, const Bitmap& b) {
  EXPECT_EQ(a.codes.size(), b.codes.size());
  int largest = 0;
  for (std::size_t i = 0; i < std::min(a.codes.size(), b.codes.size()); ++i)
    largest = std::max(largest, std::abs(a.codes[i] - b.codes[i]));
  return largest;
}

TEST(PreviewGraphics, KittyHoldsTheExactPixels) {
  for (const auto& [width, height] : {std::pair{1, 1}, {2, 1}, {64, 16}, {203, 77}}) {
    const Bitmap bitmap = gradient(width, height);
    std::map<std::string, std::string> keys;
    const Bitmap read = decoded_kitty(drawn(Graphics::kKitty, bitmap, 20, 8), &keys);
    EXPECT_EQ(read.width, width);
    EXPECT_TRUE(read.codes == bitmap.codes);
    EXPECT_EQ(keys["a"] + keys["f"] + keys["c"] + keys["q"] + keys["C"], "T242021");
  }
}

TEST(PreviewGraphics, ItermHoldsAPng) {
  const Bitmap bitmap = gradient(31, 17);
  const std::string drawing = drawn(Graphics::kIterm, bitmap, 4, 1);
  const std::size_t colon = drawing.find(':');
  EXPECT_TRUE(drawing.starts_with("\033]1337;File=inline=1;"));
  EXPECT_NE(drawing.find("width=4;height=1;"), std::string::npos);
  EXPECT_EQ(drawing.back(), '\a');
  const std::string png = decoded_base64(drawing.substr(colon + 1, drawing.size() - colon - 2));
  EXPECT_NE(drawing.find("size=" + std::to_string(png.size()) + ";"), std::string::npos);
  EXPECT_TRUE(decoded_png(png).codes == bitmap.codes);
}

TEST(PreviewGraphics, SixelsDrawEveryPixelOnceInANeighbouringLevel) {
  for (const auto& [width, height] : {std::pair{1, 1}, {5, 6}, {40, 13}, {300, 100}}) {
    const Bitmap bitmap = gradient(width, height);
    const Bitmap read = decoded_sixel(drawn(Graphics::kSixel, bitmap, 1, 1));
    EXPECT_EQ(read.height, height);
    EXPECT_LT(largest_difference(read, bitmap), 51);
  }
}

TEST(PreviewGraphics, DitherKeepsTheMean) {
  for (const int code : {0, 1, 20, 51, 100, 128, 200, 254, 255}) {
    const Bitmap flat{64, 64, std::vector<std::uint8_t>(64 * 64 * 3, static_cast<std::uint8_t>(code))};
    const Bitmap read = decoded_sixel(sixel(flat));
    double sum = 0;
    for (const int v : read.codes) sum += v;
    EXPECT_NEAR(sum / static_cast<double>(read.codes.size()), code, 51.0 / 16) << code;
  }
}

TEST(PreviewGraphics, HalfBlocksShowTwoPixelsPerCell) {
  const Bitmap bitmap = gradient(50, 20);
  EXPECT_TRUE(decoded_half_blocks(drawn(Graphics::kTrueColor, bitmap, 50, 10)).codes == bitmap.codes);
  const Bitmap odd = gradient(3, 5);
  const Bitmap read = decoded_half_blocks(half_blocks(odd, true));
  EXPECT_EQ(read.height, 6);
  EXPECT_TRUE(std::equal(odd.codes.begin(), odd.codes.end(), read.codes.begin()));
}

TEST(PreviewGraphics, PaletteColoursAreTheNearest) {
  std::vector<std::array<int, 3>> palette;
  const int levels[] = {0, 95, 135, 175, 215, 255};
  for (const int r : levels)
    for (const int g : levels)
      for (const int b : levels) palette.push_back({r, g, b});
  for (int i = 0; i < 24; ++i) palette.push_back({8 + 10 * i, 8 + 10 * i, 8 + 10 * i});
  const auto distance = [](const auto& a, const auto& b) {
    int sum = 0;
    for (std::size_t c = 0; c < 3; ++c) sum += (a[c] - b[c]) * (a[c] - b[c]);
    return sum;
  };
  const Bitmap bitmap = gradient(60, 40);
  const Bitmap read = decoded_half_blocks(drawn(Graphics::k256Colors, bitmap, 60, 20));
  ASSERT_EQ(read.codes.size(), bitmap.codes.size());
  for (std::size_t i = 0; i < read.codes.size(); i += 3) {
    const std::array<int, 3> want{bitmap.codes[i], bitmap.codes[i + 1], bitmap.codes[i + 2]};
    const std::array<int, 3> got{read.codes[i], read.codes[i + 1], read.codes[i + 2]};
    int nearest = distance(want, palette[0]);
    for (const auto& color : palette) nearest = std::min(nearest, distance(want, color));
    EXPECT_EQ(distance(want, got), nearest);
  }
}

}  // namespace
}  // namespace orrery::preview
