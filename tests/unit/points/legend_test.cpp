// SPDX-License-Identifier: Apache-2.0
#include "points/legend.h"

#include <gtest/gtest.h>

#include <cmath>

#include "points/color_map.h"

namespace orrery::points {
namespace {

Legend speed_legend() {
  Legend legend;
  legend.title = "speed";
  const ColorMap& map = *find_color_map("viridis");
  for (int i = 0; i < 64; ++i) {
    const Vec3d c = 255 * srgb_at(map, i / 63.0);
    legend.bar.push_back({static_cast<std::uint8_t>(std::lround(c.x)), static_cast<std::uint8_t>(std::lround(c.y)),
                          static_cast<std::uint8_t>(std::lround(c.z))});
  }
  legend.first = 0;
  legend.last = 12;
  return legend;
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t i = text.find(part); i != std::string::npos; i = text.find(part, i + 1)) ++count;
  return count;
}

TEST(PointsLegend, BarHasTitleTicksAndColors) {
  const std::string svg = legend_svg(speed_legend());
  EXPECT_EQ(svg.substr(0, 42), "<svg xmlns=\"http://www.w3.org/2000/svg\" wi");
  EXPECT_TRUE(contains(svg, ">speed</text>"));
  for (const char* label : {">0<", ">2<", ">4<", ">6<", ">8<", ">10<", ">12<"})
    EXPECT_TRUE(contains(svg, label)) << label;
  EXPECT_EQ(count_of(svg, "<stop "), 64u);
  EXPECT_TRUE(contains(svg, "<stop offset=\"0.00%\" stop-color=\"#440154\"/>"));
  EXPECT_TRUE(contains(svg, "<stop offset=\"100.00%\" stop-color=\"#fde725\"/>"));
  EXPECT_FALSE(contains(svg, "no value"));
  // The first value is at the bottom of the bar, 240 px below the last.
  EXPECT_TRUE(contains(svg, "<text x=\"48.00\" y=\"291.90\">0</text>"));
  EXPECT_TRUE(contains(svg, "<text x=\"48.00\" y=\"51.90\">12</text>"));
}

TEST(PointsLegend, ReversedRangeIsReversed) {
  Legend legend = speed_legend();
  std::swap(legend.first, legend.last);
  EXPECT_TRUE(contains(legend_svg(legend), "y=\"51.90\">0</text>"));
}

TEST(PointsLegend, PatchesAndNan) {
  Legend legend;
  legend.title = "element";
  legend.patches = {{"C", {144, 144, 144}}, {"O", {255, 13, 13}}};
  legend.nan_color = Srgb8{1, 2, 3};
  const std::string svg = legend_svg(legend);
  EXPECT_EQ(count_of(svg, "<rect x="), 3u);
  EXPECT_TRUE(contains(svg, "fill=\"#909090\""));
  EXPECT_TRUE(contains(svg, ">O</text>"));
  EXPECT_TRUE(contains(svg, "fill=\"#010203\""));
  EXPECT_TRUE(contains(svg, ">no value</text>"));
  EXPECT_FALSE(contains(svg, "linearGradient"));
}

TEST(PointsLegend, StringsAreEscapedAndTruncated) {
  Legend legend;
  legend.title = "a<b & c>d\x01\xFF \xC3\xA5 \xED\xA0\x80 \xEF\xBF\xBF";
  const std::string svg = legend_svg(legend);
  EXPECT_TRUE(contains(svg, ">a&lt;b &amp; c&gt;d?? \xC3\xA5 ??? ?\?\?</text>")) << svg;
  legend.title = std::string(1'000'000, 'x');
  EXPECT_LT(legend_svg(legend).size(), 1000u);
  EXPECT_TRUE(contains(legend_svg(legend), "xxx…</text>"));
}

TEST(PointsLegend, EmptyLegendIsAnImage) {
  EXPECT_TRUE(contains(legend_svg({}), "</svg>"));
  Legend legend = speed_legend();
  legend.first = legend.last = 3.5;
  legend.bar.resize(1);
  EXPECT_TRUE(contains(legend_svg(legend), ">3.5</text>"));
}

TEST(PointsLegend, PixelsOfTheBarBeginWithTheLastColor) {
  const std::vector<Srgb8> bar = {{0, 0, 0}, {100, 200, 50}};
  const std::vector<Srgb8> pixels = bar_pixels(bar, 2, 5);
  ASSERT_EQ(pixels.size(), 10u);
  EXPECT_EQ(pixels[0], bar[1]);
  EXPECT_EQ(pixels[1], bar[1]);
  EXPECT_EQ(pixels[4], (Srgb8{50, 100, 25}));
  EXPECT_EQ(pixels[9], bar[0]);
  EXPECT_EQ(bar_pixels(bar, 1, 1), (std::vector<Srgb8>{{50, 100, 25}}));
  EXPECT_EQ(bar_pixels({{1, 2, 3}}, 1, 3), (std::vector<Srgb8>(3, Srgb8{1, 2, 3})));
}

}  // namespace
}  // namespace orrery::points
