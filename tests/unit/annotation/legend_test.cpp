// SPDX-License-Identifier: Apache-2.0
#include "annotation/legend.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "base/error.h"
#include "display/settings.h"
#include "image/draw_text.h"
#include "image/read.h"
#include "support/temp_dir.h"

namespace orrery::annotation {
namespace {

LegendColors speed() {
  LegendColors out;
  out.title = "speed";
  out.bar = {{0, 0, 0.25}, {0.5, 0.5, 0.5}, {1, 1, 0}};
  out.range = scene::Interval{0, 12};
  return out;
}

Drawing drawing_of(const LegendColors& colors, std::size_t most_labels = 100) {
  return legend_drawing(colors, {20, 1000, most_labels, 60}, image::font_file("DejaVuSans"));
}

/// The line that begins with a text.
image::TextLine line(const Drawing& drawing, const std::string& text) {
  for (const image::TextLine& one : drawing.texts)
    if (one.text.starts_with(text)) return one;
  ADD_FAILURE() << "no text " << text;
  return {};
}

TEST(AnnotationLegend, TicksAreBesideTheColorsOfTheirValues) {
  const Drawing drawing = drawing_of(speed());
  ASSERT_EQ(drawing.bars.size(), 1u);
  const Bar& bar = drawing.bars[0];
  const double middle = line(drawing, "6").y;
  EXPECT_NEAR(line(drawing, "12").y - middle, (bar.top - bar.bottom) / 2, 1e-9);
  EXPECT_NEAR(line(drawing, "0").y - middle, (bar.bottom - bar.top) / 2, 1e-9);
  EXPECT_LT(line(drawing, "speed").y, bar.top);
  LegendColors reversed = speed();
  std::swap(reversed.range->low, reversed.range->high);
  EXPECT_LT(line(drawing_of(reversed), "0").y, line(drawing_of(reversed), "12").y);
}

TEST(AnnotationLegend, BarsAreAtMostAsHighAsTheirSpace) {
  const LegendColors colors = speed();
  const Drawing low = legend_drawing(colors, {20, 150, 100, 60}, image::font_file("DejaVuSans"));
  EXPECT_LE(low.height, 150);
  EXPECT_LT(low.height, drawing_of(colors).height);
  const Bar none = legend_drawing(colors, {20, 0, 100, 60}, image::font_file("DejaVuSans")).bars[0];
  EXPECT_EQ(none.bottom - none.top, 1) << "an image of a few pixels";
}

TEST(AnnotationLegend, LabelsBeyondTheMostAreCounted) {
  LegendColors colors;
  colors.title = "type";
  for (int i = 1; i <= 30; ++i) colors.labels[std::to_string(i)] = {i / 30.0, 0, 0};
  EXPECT_EQ(drawing_of(colors, 30).texts.size(), 31u);
  const Drawing drawing = drawing_of(colors, 20);
  EXPECT_EQ(drawing.texts.size(), 21u);
  EXPECT_EQ(drawing.texts.back().text, "11 more");
}

TEST(AnnotationLegend, LongTextsAreTruncated) {
  LegendColors colors = speed();
  colors.title = std::string(1'000'000, 'x');
  EXPECT_LT(drawing_of(colors).width, 2000);
  colors.title = "a<b\x01";
  display::Settings display;
  display.view = "Un-tone-mapped";
  const support::TempDir folder;
  write_legend(folder / "legend.svg", colors, display);
  EXPECT_NE(support::file_bytes(folder / "legend.svg").find(">a&lt;b?</text>"), std::string::npos);
}

/// The frames keep white patches visible on white.
TEST(AnnotationLegend, FilesHaveTheColorsOfTheImages) {
  const support::TempDir folder;
  LegendColors colors;
  colors.title = "type";
  colors.labels = {{"1", {1, 0, 0}}, {"2", {1, 1, 1}}};
  colors.nan_color = Vec3d{0, 0, 1};  // of bars only
  display::Settings display;
  display.view = "Un-tone-mapped";
  write_legend(folder / "l.png", colors, display);
  const film::Picture picture = image::read(folder / "l.png");
  int red = 0, framed_white = 0;
  const auto at = [&](int x, int y, std::size_t channel) {
    return picture.planes[channel].values[static_cast<std::size_t>(y * picture.width + x)];
  };
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      const float r = at(x, y, 0), g = at(x, y, 1), b = at(x, y, 2);
      red += r > 0.99F && g < 0.01F && b < 0.01F ? 1 : 0;
      EXPECT_FALSE(r < 0.01F && g < 0.01F && b > 0.99F);
      // To the left of it, in its row, is black.
      if (x < 3 || !(r > 0.99F && g > 0.99F && b > 0.99F)) continue;
      framed_white += at(x - 1, y, 0) < 0.01F && at(x - 2, y, 0) < 0.6F ? 1 : 0;
    }
  EXPECT_NEAR(red, 28 * 28, 60);
  EXPECT_GT(framed_white, 20);
  write_legend(folder / "l.svg", speed(), display);
  EXPECT_THROW(write_legend(folder / "l.exr", speed(), display), base::Error);
  EXPECT_THROW(write_legend(folder / "l.svg", {}, display), base::Error);
  for (int i = 0; i < 600; ++i) colors.labels[std::to_string(i)] = {0, 0, 0};
  EXPECT_THROW(write_legend(folder / "l.png", colors, display), base::Error);
  EXPECT_NO_THROW(write_legend(folder / "l.svg", colors, display));
}

}  // namespace
}  // namespace orrery::annotation
