// SPDX-License-Identifier: Apache-2.0
#include "plot/settings.h"

#include <gtest/gtest.h>

#include <initializer_list>

#include "base/error.h"
#include "plot/plot.h"

namespace orrery::plot {
namespace {

PlotOptions with_settings(std::initializer_list<const char*> settings) {
  PlotOptions out;
  out.scene_file = "scene.toml";
  for (const char* const setting : settings) out.overrides.add(setting);
  return out;
}

TEST(PlotSettings, TheCameraKnowsTheSizeOfTheImage) {
  const PlotOptions options = with_settings({"image.width=640", "image.height=0"});
  EXPECT_EQ(side_of(options.overrides, "image.width", 1920), 640);
  EXPECT_EQ(side_of(options.overrides, "image.height", 1080), 1) << "the scene's reader reports it";
  EXPECT_EQ(side_of({}, "image.width", 1920), 1920);
}

TEST(PlotSettings, AFieldOfViewMakesAPerspectiveCamera) {
  EXPECT_FALSE(vfov_of({}));
  EXPECT_EQ(vfov_of(with_settings({"camera.vfov=30"})), 30);
  EXPECT_EQ(vfov_of(with_settings({"camera.projection=\"perspective\"", "camera.vfov=30"})), 30);
  EXPECT_FALSE(vfov_of(with_settings({"camera.projection=\"orthographic\"", "camera.vfov=30"})));
  EXPECT_EQ(vfov_of(with_settings({"camera.vfov=200"})), scene::Camera().vfov) << "the scene's reader reports it";
  PlotOptions options = with_settings({});
  options.vfov_deg = 20;
  EXPECT_EQ(vfov_of(options), 20);
}

TEST(PlotSettings, AProvisionalSceneHasTheTablesOfAllScenes) {
  const scene::Scene scene =
      settings_scene(with_settings({"image.width=640", "points=[{file=\"missing.csv\"}]", "render.samples=3"}), false)
          .read.scene;
  EXPECT_EQ(scene.image.width, 640);
  EXPECT_EQ(scene.render.samples, 3);
  EXPECT_TRUE(scene.points.empty());
  EXPECT_THROW(settings_scene(with_settings({"image.width=0"}), false), base::Error);
}

TEST(PlotSettings, TheLegendHasTheViewOfThePlot) {
  PlotScene made;
  made.view = kPlainView;
  EXPECT_EQ(display_of(with_settings({"color.view=\"Raw\""})).view, "Raw");
  EXPECT_EQ(legend_display(with_settings({"color.view=\"Raw\""}), made).view, kPlainView);
}

TEST(PlotSettings, ASavedSceneHasTheSettings) {
  PlotScene made;
  made.text = "# Written by a test\n[image]\nwidth = 640\n";
  EXPECT_EQ(saved_text(with_settings({"image.width=320"}), made), made.text) << "the plot has used it";
  const std::string text = saved_text(with_settings({"image.width=320", "render.samples=7"}), made);
  EXPECT_NE(text.find("samples = 7"), std::string::npos) << text;
  EXPECT_NE(text.find("width = 640"), std::string::npos) << text;
  EXPECT_EQ(text.find("# Written by a test\n"), 0u) << text;
  EXPECT_EQ(saved_text(with_settings({"render.samples=0"}), made), made.text) << "reported when it is rendered";
}

}  // namespace
}  // namespace orrery::plot
