// SPDX-License-Identifier: Apache-2.0
#include "app/precision_advice.h"

#include <gtest/gtest.h>

#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "scene/scene.h"

namespace orrery::app {
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

TEST(AppPrecisionAdvice, IsEmptyIfThePrecisionIsSufficient) {
  EXPECT_EQ(advice_for(scene::Precision::kExact, 1e12, 1e-3, 1e9), 0u);
  EXPECT_EQ(advice_for(scene::Precision::kFast, 10, 1, 0), 0u);
  EXPECT_EQ(advice_for(scene::Precision::kBook, 10, 1, 0), 0u);
}

TEST(AppPrecisionAdvice, WarnsAboutDistantScenesInFastAndAboutDistanceAndSmallRadiiInBook) {
  EXPECT_EQ(advice_for(scene::Precision::kFast, 10, 1, 1e6), 1u);
  EXPECT_EQ(advice_for(scene::Precision::kBook, 1e8, 1, 0), 1u);
  EXPECT_EQ(advice_for(scene::Precision::kBook, 0.1, 0.01, 0), 1u);
}

}  // namespace
}  // namespace orrery::app
