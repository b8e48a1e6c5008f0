// SPDX-License-Identifier: Apache-2.0
#include "compile/environment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "scene/lat_long_map.h"
#include "scene/scene.h"

namespace orrery::compile {
namespace {

using scene::LatLongMap;

using std::numbers::pi;

std::shared_ptr<LatLongMap> uniform_image(int width, int height, float radiance) {
  auto image = std::make_shared<LatLongMap>(width, height);
  for (int y = 0; y < height; ++y) std::fill_n(image->row(y), 3 * width, radiance);
  return image;
}

TEST(CompileEnvironment, PowerIsTheIntegralOfTheRadiance) {
  EnvironmentSettings settings;
  settings.scale = 0.5;
  const auto image = uniform_image(10, 5, 3);
  EXPECT_NEAR(EnvironmentMap(image, settings).view().power, 4 * pi * 1.5, 1e-12);
  image->sun = {{0, 1, 0}, 1e-5, {6e5, 3e5, 0}};
  EXPECT_NEAR(EnvironmentMap(image, settings).view().power, 4 * pi * 1.5 + 2 * pi * 1e-5 * 1.5e5, 1e-9);
}

TEST(CompileEnvironment, AUniformMapIsNotSampledInAdditionToBsdfs) {
  for (const float radiance : {0.1F, 1.0F, 12345.678F})
    EXPECT_FALSE(EnvironmentMap(uniform_image(33, 16, radiance), {}).view().is_sampled) << radiance;
  EnvironmentSettings alone;
  alone.sampling = EnvironmentSampling::kComplete;
  EXPECT_TRUE(EnvironmentMap(uniform_image(33, 16, 1), alone).view().is_sampled);
  EXPECT_FALSE(EnvironmentMap(uniform_image(33, 16, 0), alone).view().is_sampled) << "black";
}

TEST(CompileEnvironment, OnlyTheSunOfAUniformMapIsSampled) {
  const auto image = uniform_image(32, 16, 1);
  image->sun = {{0, 1, 0}, 1e-5, {1e5, 1e5, 1e5}};
  const EnvironmentMap map(image, {});
  EXPECT_TRUE(map.view().is_sampled);
  EXPECT_EQ(map.view().sun_probability, 1);
  EXPECT_EQ(map.view().map_density, 0);
}

TEST(CompileEnvironment, WithoutLightSamplingThereAreNoTables) {
  EnvironmentSettings settings;
  settings.sampling = EnvironmentSampling::kNone;
  const auto image = uniform_image(8, 4, 1);
  image->row(1)[3] = 100;
  const EnvironmentMap map(image, settings);
  EXPECT_FALSE(map.view().is_sampled);
  EXPECT_EQ(map.view().level_count, 0u);
  EXPECT_GT(map.view().power, 0);
}

TEST(CompileEnvironment, SumsAreThoseOfTheLevelBelow) {
  EnvironmentSettings settings;
  settings.sampling = EnvironmentSampling::kComplete;
  const EnvironmentMap map(uniform_image(32, 15, 1), settings);
  const kernel::Environment& env = map.view();
  // 32 x 16 cells, so 16 x 8 nodes in blocks of 8 x 4, and so on up to 2 x 1 nodes.
  ASSERT_EQ(env.level_count, 4u);
  EXPECT_EQ(env.levels[3].blocks_per_row, 8u);
  for (std::uint32_t k = 0; k + 1 < env.level_count; ++k) {
    for (int i = 0; i < 4; ++i) {
      const float* const below = env.levels[k + 1].blocks +
                                 4 * (static_cast<std::size_t>(i / 2) * env.levels[k + 1].blocks_per_row) + 4 * (i % 2);
      if (env.levels[k].blocks[i] == 0) continue;  // outside the map
      EXPECT_FLOAT_EQ(env.levels[k].blocks[i], below[0] + below[1] + below[2] + below[3]) << k << ' ' << i;
    }
  }
  EXPECT_EQ(env.levels[0].blocks[2], 0) << "twice as wide as high";
}

TEST(CompileEnvironment, RowsOfCellsCoverTheSphere) {
  for (const int height : {1, 2, 3, 8, 1025}) {
    EnvironmentSettings settings;
    settings.sampling = EnvironmentSampling::kComplete;
    const EnvironmentMap map(uniform_image(4, height, 1), settings);
    double sum = 0;
    for (int j = 0; j <= height; ++j) {
      const kernel::EnvironmentRow& row = map.view().rows[j];
      sum += std::abs(row.width);
      EXPECT_EQ(row.width > 0, 2 * j <= height) << height << ' ' << j;
    }
    EXPECT_NEAR(sum, 2, 1e-13) << height;
  }
}

TEST(CompileEnvironment, SceneSettingsReachTheView) {
  scene::Scene s;
  s.background.type = scene::BackgroundType::kImage;
  s.background.image = uniform_image(8, 4, 1);
  s.background.rotation = -90;
  s.background.exposure = 3;
  s.background.light_group = "sky";
  s.background.visible = false;
  const CompiledScene compiled = compile(s);
  ASSERT_NE(compiled.view().environment, nullptr);
  const kernel::Environment& env = *compiled.view().environment;
  EXPECT_EQ(env.turn, 0.75);
  EXPECT_EQ(env.scale, 8);
  EXPECT_EQ(compiled.light_groups.at(env.light_group), "sky");
  EXPECT_FALSE(env.visible);
  EXPECT_EQ(compile({}).view().environment, nullptr);
}

TEST(CompileEnvironment, RotationTurnsTheSun) {
  const auto image = uniform_image(8, 4, 1);
  image->sun = {{0, 0, 1}, 1e-5, {1, 1, 1}};
  EnvironmentSettings settings;
  settings.rotation = 90;
  const EnvironmentMap map(image, settings);
  EXPECT_NEAR(map.view().sun.x, 1, 1e-15);
  EXPECT_NEAR(map.view().sun.z, 0, 1e-15);
}

}  // namespace
}  // namespace orrery::compile
