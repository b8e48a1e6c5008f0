// SPDX-License-Identifier: Apache-2.0
#include "plot/scene_text.h"

#include <gtest/gtest.h>

#include <memory>

#include "base/error.h"
#include "load/read_scene.h"
#include "plot/plot.h"

namespace orrery::plot {
namespace {

class PlotSceneText : public testing::Test {
 protected:
  /// The scene of a plot of one point, as it is read.
  scene::Scene read() {
    scene::Scene scene;
    scene.points.emplace_back().file = "a.csv";
    scene.rods = rods;
    const Stage stage{axes, {0, 0, 1}, material, {1, 2, 3}, radius, 10, ground, gain};
    const load::SceneSource source{.file = "plot",
                                   .text = std::make_shared<const std::string>(scene_text(options, stage, scene))};
    load::SceneReader reader(source, load::Pose::kAuthored);
    EXPECT_FALSE(reader.has_errors()) << *source.text;
    return reader.scene();
  }
  static Vec3d radiance_of(const scene::Scene& scene, const scene::Sphere& lamp) {
    return std::get<scene::Emitter>(scene.materials.at(lamp.material).model).radiance;
  }

  PlotOptions options;
  ViewAxes axes = view_axes(kDefaultView, "z");
  std::string material = "matte";
  double radius = 2, gain = 1;
  std::optional<Ground> ground;
  std::vector<scene::Rod> rods;
};

TEST_F(PlotSceneText, TheLampIsToTheUpperLeftOfTheCamera) {
  const scene::Scene scene = read();
  ASSERT_EQ(scene.spheres.size(), 1u);
  const Vec3d to_lamp = scene.spheres[0].center - Vec3d{1, 2, 3};
  EXPECT_GT(math::dot(to_lamp, axes.up), 0);
  EXPECT_LT(math::dot(to_lamp, axes.right), 0);
  EXPECT_GT(math::dot(to_lamp, axes.back), radius) << "on the camera's side";
}

TEST_F(PlotSceneText, TheGainMultipliesAllLight) {
  const scene::Scene once = read();
  gain = 2;
  const scene::Scene twice = read();
  EXPECT_EQ(radiance_of(twice, twice.spheres[0]), radiance_of(once, once.spheres[0]) * 2.0);
  EXPECT_EQ(twice.background.top, once.background.top * 2.0);
  EXPECT_EQ(twice.background.backdrop, once.background.backdrop) << "it lights nothing";
}

TEST_F(PlotSceneText, RodsHaveTheMaterialOfTheirName) {
  rods = {{{0, 0, 0}, {1, 0, 0}, 0.1, {}, "box"}, {{0, 0, 0}, {1, 0, 0}, 0.1, {}, "axis_x"}};
  const scene::Scene scene = read();
  for (const scene::Rod& rod : scene.rods)
    for (const std::uint32_t end : rod.materials) EXPECT_EQ(scene.materials.at(end).name, rod.name);
  for (const scene::Material& m : scene.materials) EXPECT_NE(m.name, "axis_y") << "there is no such rod";
}

TEST_F(PlotSceneText, TheGroundIsAPageUnlessTheStyleIsDark) {
  ground = Ground{{1, 2, -2000}, 1999};
  EXPECT_TRUE(read().spheres.at(0).is_page);
  options.style = Style::kNight;
  EXPECT_FALSE(read().spheres.at(0).is_page);
}

TEST_F(PlotSceneText, WhatIsTooFarAwayIsAnError) {
  radius = 1e300;
  EXPECT_THROW(read(), base::Error);
}

TEST_F(PlotSceneText, NamesAreThoseOfTheEnumerators) {
  EXPECT_EQ(style_of("night"), Style::kNight);
  EXPECT_EQ(quality_of("final"), Quality::kFinal);
  EXPECT_FALSE(style_of(""));
  EXPECT_EQ(style_names().size(), static_cast<std::size_t>(Style::kIllustration) + 1);
  EXPECT_EQ(quality_names().size(), static_cast<std::size_t>(Quality::kFinal) + 1);
}

TEST_F(PlotSceneText, GuidesSurroundWhatIsShown) {
  scene::Points points;
  points.centers.push_back({5, 5, 5});
  points.radii.push_back(1);
  Guides guides({0, 0, 1});
  guides.surround(points);
  EXPECT_EQ(guides.lowest(), 4);
  EXPECT_EQ(guides.reach(), 6);
  ViewExtent extent(axes);
  extent.add(points);
  guides.add_box(data::Box{{-1, 0, 0}, {Vec3d{2, 0, 0}, Vec3d{0, 3, 0}, Vec3d{0, 0, 4}}}, {1, 1, 2}, extent);
  EXPECT_EQ(guides.rods().size(), 12u);
  EXPECT_LT(guides.lowest(), 0);
  EXPECT_EQ(guides.reach(), 8) << "of two boxes along z";
  guides.add_axes(extent, std::nullopt);
  ASSERT_EQ(guides.rods().size(), 15u);
  for (std::size_t i = 12; i < 15; ++i) EXPECT_LT(guides.rods()[i].to.x, -1) << "outside the lower corner";
  EXPECT_EQ(guides.ends().centers.size(), 30u);
}

}  // namespace
}  // namespace orrery::plot
