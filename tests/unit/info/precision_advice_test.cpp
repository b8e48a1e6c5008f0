// SPDX-License-Identifier: Apache-2.0
#include "info/info.h"

#include <gtest/gtest.h>

#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "scene/scene.h"
#include "support/mentions.h"

namespace orrery::info {
namespace {

std::size_t advice_for(scene::Precision precision, double camera_distance, double radius, double offset) {
  scene::Scene s;
  s.render.precision = precision;
  s.camera.look_from = {offset, 0, camera_distance};
  s.camera.look_at = {offset, 0, 0};
  s.materials = {{"m", scene::Lambertian{}}};
  s.spheres = {{{offset, 0, 0}, radius, 0, ""}};
  return precision_advice(compile::compile(s)).size();
}

TEST(InfoPrecisionAdvice, IsEmptyIfThePrecisionIsSufficient) {
  EXPECT_EQ(advice_for(scene::Precision::kExact, 1e12, 1e-3, 1e9), 0u);
  EXPECT_EQ(advice_for(scene::Precision::kFast, 10, 1, 0), 0u);
  EXPECT_EQ(advice_for(scene::Precision::kBook, 10, 1, 0), 0u);
}

TEST(InfoPrecisionAdvice, WarnsAboutDistantScenesInFastAndAboutDistanceAndSmallRadiiInBook) {
  EXPECT_EQ(advice_for(scene::Precision::kFast, 10, 1, 1e6), 1u);
  EXPECT_EQ(advice_for(scene::Precision::kBook, 1e8, 1, 0), 1u);
  EXPECT_EQ(advice_for(scene::Precision::kBook, 0.1, 0.01, 0), 1u);
}

TEST(InfoPrecisionAdvice, WarnsAboutASunkLampInFast) {
  const auto advice_of = [](scene::Precision precision, double ground, double lamp_height, bool glows = true) {
    scene::Scene s;
    s.render.precision = precision;
    s.materials = {{"ground", scene::Lambertian{}}, {"lamp", scene::Emitter{}}};
    s.spheres = {{{0, -ground, 0}, ground, 0, ""}, {{0, lamp_height, 0}, 2, glows ? 1u : 0u, ""}};
    return precision_advice(compile::compile(s));
  };
  ASSERT_EQ(advice_of(scene::Precision::kFast, 1e4, 0).size(), 1u);
  EXPECT_TRUE(test::mentions(advice_of(scene::Precision::kFast, 1e4, 0)[0], {"2", "10000", "0.001"}));
  EXPECT_EQ(advice_of(scene::Precision::kFast, 1e4, 5).size(), 0u) << "the lamp is above the ground";
  EXPECT_EQ(advice_of(scene::Precision::kFast, 1e4, 0, false).size(), 0u) << "it is no lamp";
  EXPECT_EQ(advice_of(scene::Precision::kFast, 1e3, 0).size(), 0u);
  EXPECT_EQ(advice_of(scene::Precision::kExact, 1e4, 0).size(), 0u);
}

}  // namespace
}  // namespace orrery::info
