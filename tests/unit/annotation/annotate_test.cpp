// SPDX-License-Identifier: Apache-2.0
#include "annotation/annotate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.h"

namespace orrery::annotation {
namespace {

std::string error_of(const std::string& title) {
  try {
    title_of(title, 1, {});
  } catch (const base::Error& error) {
    return error.what();
  }
  return "no error";
}

class AnnotationAnnotate : public testing::Test {
 protected:
  AnnotationAnnotate() {
    scene.camera.projection = scene::Projection::kOrthographic;
    scene.camera.width = 50;
    scene.background.type = scene::BackgroundType::kConstant;
    scene.background.color = {1, 1, 1};
    view.width = 400;
    view.height = 320;
    view.project = [](const Vec3d& at) { return std::pair{at.x, at.y}; };
  }
  Drawing drawing() { return drawing_of(scene, legend_of(scene, ""), view); }
  /// The line with a text.
  image::TextLine line(const std::string& text) {
    const Drawing all = drawing();
    for (const auto& lines : {all.texts, all.labels})
      for (const image::TextLine& one : lines)
        if (one.text == text) return one;
    ADD_FAILURE() << "no text " << text;
    return {};
  }

  scene::Scene scene;
  View view;
};

TEST(AnnotationTitle, ExpressionsAreReplaced) {
  EXPECT_EQ(title_of("plain", 7, {}), "plain");
  EXPECT_EQ(title_of("frame {frame} of 9", 7, {}), "frame 7 of 9");
  EXPECT_EQ(title_of("t = {step * 0.005:.2f} ps, {frame:.0f}", 7, {{"step", 300}}), "t = 1.50 ps, 7");
  EXPECT_EQ(title_of("E = {energy / 2:.1f}", 7, {{"step", 300}, {"energy", -3}}), "E = -1.5");
  EXPECT_EQ(title_of("Au {{111}}, }{frame}{{", 7, {}), "Au {111}, }7{");
  EXPECT_EQ(error_of("{step}"), "annotation.title: {step}: unknown column step; columns are frame")
      << "the data have no time steps";
  EXPECT_NE(error_of("{frame").find("`{` is not closed"), std::string::npos);
  EXPECT_NE(error_of("{frame:.22f}").find("write the number of decimals"), std::string::npos);
  EXPECT_NE(error_of("{frame:q}").find("annotation.title: {frame:q}: "), std::string::npos);
  EXPECT_NE(error_of("{}").find("annotation.title: {}: "), std::string::npos);
}

TEST_F(AnnotationAnnotate, NothingByDefault) { EXPECT_TRUE(drawing().is_empty()); }

/// At 200 x 120 px the font has its smallest size.
TEST_F(AnnotationAnnotate, LongTitlesEndBesideTheColorBar) {
  scene.points.resize(1);
  scene.points[0].color.column = "speed";
  scene.points[0].color_range = scene::Interval{0, 12};
  scene.points[0].palette = {{0, 0, 0}, {1, 1, 1}};
  for (const auto& [width, height] : {std::pair{1920, 1080}, {200, 120}}) {
    view.width = width;
    view.height = height;
    scene.annotation.color_bar = false;
    scene.annotation.title = "short";
    const double size = drawing().texts[0].size_px;
    scene.annotation.color_bar = true;
    for (const std::size_t length : {20u, 100u, 1000u}) {
      scene.annotation.title = std::string(length, 'm');
      const image::TextLine title = drawing().texts[0];
      const double end = title.x + image::text_widths({title.text}, title.size_px, drawing().font)[0];
      double bar = width;
      for (const Box& box : drawing().boxes) bar = std::min(bar, box.left);
      EXPECT_LT(bar, width);
      EXPECT_LE(end, bar) << length;
      EXPECT_GE(title.size_px, 9);
      EXPECT_LE(title.size_px, size);
      EXPECT_TRUE(title.text == scene.annotation.title || title.text.ends_with("…")) << title.text;
      if (length == 1000) {
        EXPECT_GT(end, 0.6 * bar) << "most of the space is used";
      }
    }
  }
}

TEST_F(AnnotationAnnotate, ScaleBarsAreExact) {
  scene.annotation.scale_bar = 7.3;
  scene.annotation.unit = "nm";
  EXPECT_EQ(line("7.3 nm").anchor, 0);
  const Overlay overlay = draw(drawing(), [](const Vec3d& color) { return color; });
  double longest = 0;
  for (int y = 0; y < 320; ++y) {
    double length = 0;
    for (int x = 0; x < 400; ++x) length += overlay.rgba[static_cast<std::size_t>(4 * (y * 400 + x) + 3)];
    longest = std::max(longest, length);
  }
  EXPECT_NEAR(longest, 7.3 / 50 * 400, 0.01) << "of pixels, with partly covered ones at its ends";
}

TEST_F(AnnotationAnnotate, ColorBarsHaveTicks) {
  scene.annotation.color_bar = true;
  scene.points.resize(2);
  scene.points[1].color.column = "speed";
  scene.points[1].color_range = scene::Interval{0, 12};
  scene.points[1].palette = {{0, 0, 0}, {1, 1, 1}, {0.5, 0.5, 0.5}};
  EXPECT_LT(line("12").y, line("6").y) << "the largest at the top";
  EXPECT_NEAR(line("12").y - line("6").y, line("6").y - line("0").y, 1e-9);
  EXPECT_LT(line("speed").y, line("12").y);
  scene.points[1].color.log = true;
  scene.points[1].color_range = scene::Interval{1, 1e4};
  EXPECT_NEAR(line("10000").y - line("100").y, line("100").y - line("1").y, 1e-9);
}

TEST_F(AnnotationAnnotate, CategoriesHavePatches) {
  scene.annotation.color_bar = true;
  scene.points.resize(1);
  scene.points[0].color.column = "type";
  for (int i = 1; i <= 30; ++i) {
    scene.points[0].color_names.push_back(std::to_string(i));
    scene.points[0].palette.push_back({i / 30.0, 0, 0});
  }
  EXPECT_EQ(drawing().boxes.size(), 2 * 18u) << "patches and their frames";
  EXPECT_LT(line("1").y, line("18").y);
  EXPECT_LT(line("18").y, line("12 more").y);
  EXPECT_LT(line("12 more").y, 310) << "within the margin";
  view.width = 200;
  scene.points[0].color_names = {"a name longer than a quarter of the image"};
  line("a name longe…");
}

/// Palettes are in the working space: whatever it is, a legend has the colours of the spheres.
TEST_F(AnnotationAnnotate, LegendsHaveTheColorsOfTheSpheresInAnyWorkingSpace) {
  scene.points.resize(1);
  scene.points[0].color.column = "type";
  scene.points[0].color_names = {"1"};
  scene.color.space = "acescg";
  scene.points[0].palette = {{0.61309741, 0.07019372, 0.02061559}};  // red of Rec.709
  const Vec3d red = legend_of(scene, "").labels.at("1");
  EXPECT_NEAR(red.x, 1, 1e-4);
  EXPECT_NEAR(red.y, 0, 1e-4);
  EXPECT_NEAR(red.z, 0, 1e-4);
  scene.color.working = "lin_rec709";
  EXPECT_EQ(legend_of(scene, "").labels.at("1"), scene.points[0].palette[0]);
}

TEST_F(AnnotationAnnotate, ValuesWithoutAColorAreInTheLegend) {
  scene.annotation.color_bar = true;
  scene.points.resize(1);
  scene.points[0].color.column = "v";
  scene.points[0].color_range = {1, 2};
  scene.points[0].palette = {{0, 0, 0}, {1, 1, 1}, {0.5, 0.5, 0.5}};
  const std::size_t texts = drawing().texts.size();
  scene.points[0].has_nan_color = true;  // the spheres are released by now
  EXPECT_EQ(drawing().texts.size(), texts + 1);
  line("no value");
}

TEST_F(AnnotationAnnotate, TheFrameIsThatOfTheData) {
  scene.annotation.title = "{frame}";
  view.frame = 3;
  line("3");
  scene.points.resize(1);
  line("3");
  scene.points[0].frame = 7;
  line("7");
}

TEST_F(AnnotationAnnotate, LabelsAreAtTheirPoints) {
  scene.points.resize(1);
  scene.points[0].placed_labels = {{{100, 200, 0}, "Fe"}};
  EXPECT_EQ(line("Fe").x, 100);
  EXPECT_EQ(line("Fe").anchor, 0.5);
  view.project = [](const Vec3d&) { return std::optional<std::pair<double, double>>(); };
  EXPECT_TRUE(drawing().labels.empty()) << "behind the camera";
}

TEST_F(AnnotationAnnotate, TextIsWhiteOnDarkBackgrounds) {
  scene.annotation.title = "a";
  EXPECT_EQ(drawing().ink, (Vec3d{0, 0, 0}));
  scene.background.backdrop = Vec3d{0.02, 0.02, 0.02};
  EXPECT_EQ(drawing().ink, (Vec3d{1, 1, 1}));
  scene.background.alpha = 0;
  EXPECT_EQ(drawing().ink, (Vec3d{0, 0, 0})) << "a transparent background is usually put on paper";
}

TEST_F(AnnotationAnnotate, MissingFontsAndGlyphsAreReported) {
  scene.annotation.title = "ångström ψ ≥ 漢字";
  EXPECT_EQ(missing_glyphs(drawing()), "漢字");
  scene.annotation.title = "Ελλάδα";
  EXPECT_EQ(missing_glyphs(drawing()), "");
  scene.annotation.font = "NoSuchFont";
  EXPECT_THROW(drawing(), base::Error);
  scene.annotation.font = "no/such.ttf";
  EXPECT_THROW(drawing(), base::Error);
}

TEST_F(AnnotationAnnotate, LegendsHaveATitleAndACorner) {
  scene.points.emplace_back().color.column = "q";
  scene.points[0].palette = {{0, 0, 0}, {1, 1, 1}};
  scene.points[0].color_range = scene::Interval{0, 1};
  scene.annotation.color_bar = true;
  scene.annotation.title = "Title";
  scene.annotation.scale_bar = 10;
  scene.annotation.color_title = "Speed (m/s)";
  const double right = line("Speed (m/s)").x, top = line("Speed (m/s)").y;
  EXPECT_GT(right, 200);
  scene.annotation.color_at = "bottom left";
  EXPECT_LT(line("Speed (m/s)").x, right);
  EXPECT_GT(line("Speed (m/s)").y, top);
  EXPECT_LT(line("0.0").y, line("10").y) << "above the scale bar";
  scene.annotation.color_at = "top left";
  EXPECT_GT(line("Speed (m/s)").y, line("Title").y) << "below the title";
}

/// In all corners and sizes, the boxes of the scale bar and of the legend are apart.
TEST_F(AnnotationAnnotate, BarsDoNotOverlap) {
  scene.points.emplace_back().color.column = "q";
  scene.points[0].palette = {{0, 0, 0}, {1, 1, 1}};
  scene.points[0].color_range = scene::Interval{0, 1};
  scene.annotation.color_bar = true;
  scene.annotation.scale_bar = 10;
  for (const auto& [width, height] : {std::pair(200, 120), std::pair(160, 90), std::pair(1920, 1080)})
    for (const char* corner : {"top right", "bottom right", "top left", "bottom left"}) {
      view.width = width;
      view.height = height;
      scene.annotation.color_at = corner;
      const std::vector<Box> boxes = covered_by(drawing());
      const auto overlap = [](const Box& a, const Box& b) {
        return a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
      };
      const Drawing all = drawing();
      const Box scale = all.boxes.front();  // the scale bar is drawn first
      for (const Box& box : boxes) {
        EXPECT_GE(box.left, 0) << corner << width;
        EXPECT_LE(box.right, width) << corner << width;
        EXPECT_GE(box.top, 0) << corner << width;
        EXPECT_LE(box.bottom, height) << corner << width;
      }
      for (const Bar& bar : all.bars)
        EXPECT_FALSE(overlap(scale, {bar.left, bar.top, bar.right, bar.bottom, {}})) << corner << width;
    }
}

TEST_F(AnnotationAnnotate, TicksOfASmallLegendAreApart) {
  scene.points.emplace_back().color.column = "q";
  scene.points[0].palette = {{0, 0, 0}, {1, 1, 1}};
  scene.points[0].color_range = scene::Interval{0, 10};
  scene.annotation.color_bar = true;
  view.width = 200;
  view.height = 120;
  std::vector<image::TextLine> ticks = drawing().texts;
  std::sort(ticks.begin(), ticks.end(), [](const auto& a, const auto& b) { return a.y < b.y; });
  ASSERT_GE(ticks.size(), 3u);
  for (std::size_t i = 1; i < ticks.size(); ++i) EXPECT_GE(ticks[i].y - ticks[i - 1].y, ticks[i].size_px);
}

TEST_F(AnnotationAnnotate, TextsHaveTheirSizeInPrint) {
  scene.annotation.title = "T";
  EXPECT_EQ(line("T").size_px, 10);
  scene.image.dpi = 300;
  EXPECT_EQ(line("T").size_px, 33) << "8 points";
  scene.annotation.font_size = 20;
  EXPECT_EQ(line("T").size_px, 20);
}

TEST_F(AnnotationAnnotate, AxesHaveLetters) {
  scene.rods.push_back({{10, 10, 0}, {20, 10, 0}, 1, {}, "axis_x"});
  EXPECT_GT(line("x").x, 20);
  scene.rods[0].name = "box";
  EXPECT_TRUE(drawing().labels.empty());
}

}  // namespace
}  // namespace orrery::annotation
