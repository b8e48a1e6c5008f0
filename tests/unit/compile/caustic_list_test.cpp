// SPDX-License-Identifier: Apache-2.0
#include "compile/caustic_list.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "base/error.h"
#include "base/stop_point.h"
#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "scene/texture.h"

namespace orrery::compile {
namespace {

/// A floor, a mirror ball, a glass ball and a lamp.
scene::Scene stage() {
  scene::Scene s;
  s.background.type = scene::BackgroundType::kConstant;
  s.materials = {{"floor", scene::Lambertian{{0.5, 0.5, 0.5}}},
                 {"mirror", scene::Metal{{0.9, 0.9, 0.9}, 0}},
                 {"glass", scene::Dielectric{1.5}},
                 {"lamp", scene::Emitter{{10, 10, 10}}}};
  s.spheres = {{{0, -1000, 0}, 1000, 0, ""}, {{-1, 1, 0}, 1, 1, ""}, {{2, 1, 0}, 1, 2, ""}, {{0, 6, 0}, 0.5, 3, ""}};
  return s;
}

std::size_t listed_in(const CompiledScene& compiled) {
  std::size_t pairs = 0;
  for (const kernel::CausticBall& ball : compiled.caustics.balls) pairs += ball.end - ball.begin;
  return pairs;
}

std::size_t pairs_of(const std::function<void(scene::Scene&)>& change) {
  scene::Scene s = stage();
  change(s);
  return listed_in(compile(s));
}

TEST(CompileCausticList, ListsEachBallWithEachLight) {
  const CompiledScene compiled = compile(stage());
  const kernel::Caustics list = compiled.view().caustics;
  EXPECT_TRUE(compiled.features.caustics);
  ASSERT_EQ(list.count, 2u);
  EXPECT_EQ(listed_in(compiled), 2u);
  EXPECT_TRUE(list.has(1, 3));
  EXPECT_TRUE(list.has(2, 3));
  EXPECT_FALSE(list.has(0, 3));
  EXPECT_FALSE(list.has(1, 2));
  EXPECT_FALSE(list.has(1, kernel::kSun));
  EXPECT_FALSE(list.has(kernel::kNone, 3));
  EXPECT_GT(list.balls[0].power, 0);
}

/// Shares of power of a ball's lights.
TEST(CompileCausticList, LightsAreChosenByTheirIrradianceAtTheBall) {
  scene::Scene s = stage();
  s.spheres.push_back({{-1, 21, 0}, 1, 3, ""});
  const CausticList list = compile(s).caustics;
  const kernel::CausticBall& ball = list.balls[0];
  ASSERT_EQ(ball.end - ball.begin, 2u);
  const double near = 0.25 / 26, far = 1.0 / 400;
  EXPECT_DOUBLE_EQ(list.lights[ball.begin].probability, near / (near + far));
  EXPECT_DOUBLE_EQ(list.lights[ball.begin + 1].probability, far / (near + far));
  EXPECT_EQ(list.lights[ball.begin + 1].cumulative, 1);
}

TEST(CompileCausticList, LeavesOutWhatIsNotSampled) {
  const auto texture = std::make_shared<const scene::Texture>();
  const std::function<void(scene::Scene&)> leave_out_one[] = {
      [](scene::Scene& s) {
        s.materials[1].model = scene::Metal{{0.9, 0.9, 0.9}, 0.01};
      },
      [](scene::Scene& s) {
        s.materials[1].model = scene::Metal{{0, 0, 0}, 0};
      },
      [&](scene::Scene& s) {
        s.materials[1].model = scene::Metal{{0.9, 0.9, 0.9}, 0, texture};
      },
      [&](scene::Scene& s) {
        s.materials[1].model = scene::Metal{{0.9, 0.9, 0.9}, 0, {}, texture};
      },
      [](scene::Scene& s) {
        s.materials[1].model = scene::Metal{{0.9, 0.9, 0.9}, 0, {}, {}, 0};
      },
      [](scene::Scene& s) { s.materials[2].model = scene::Dielectric{0.9}; },
      [](scene::Scene& s) {
        s.materials[2].model = scene::Dielectric{1.5, scene::Fresnel::kExact, 0.01};
      },
      [](scene::Scene& s) { s.spheres[2].radius = -1; },
      [](scene::Scene& s) {
        s.spheres[3] = {{-1, 2.4, 0}, 0.5, 3, ""};
      },
      [](scene::Scene& s) {
        s.spheres[3] = {{2, 1, 0}, 0.5, 3, ""};
      },
  };
  for (std::size_t i = 0; i < std::size(leave_out_one); ++i) EXPECT_EQ(pairs_of(leave_out_one[i]), 1u) << i;
  const std::function<void(scene::Scene&)> leave_out_all[] = {
      [](scene::Scene& s) { s.render.caustics = false; },
      [](scene::Scene& s) { s.render.direct_lighting = scene::DirectLighting::kBsdf; },
      [](scene::Scene& s) { s.render.precision = scene::Precision::kBook; },
      [](scene::Scene& s) {
        s.materials[3].model = scene::Emitter{{0, 0, 0}};
      },
      [&](scene::Scene& s) {
        s.materials[3].model = scene::Emitter{{1, 1, 1}, 0, {}, texture};
      },
  };
  for (std::size_t i = 0; i < std::size(leave_out_all); ++i) EXPECT_EQ(pairs_of(leave_out_all[i]), 0u) << i;
}

/// The sphere that makes ball 2 hollow.
std::uint32_t void_in(const scene::Scene& opening, const scene::Scene* closing = nullptr) {
  return compile(opening, closing).caustics.balls.back().inner;
}

TEST(CompileCausticList, ConcentricVoidsMakeBallsHollow) {
  scene::Scene s = stage();
  EXPECT_EQ(void_in(s), kernel::kNone);
  s.spheres.push_back({{2, 1, 0}, -0.5, 2, ""});
  EXPECT_EQ(void_in(s), 4u);
  s.materials.push_back({"air", scene::Dielectric{1 / 1.5}});
  s.spheres.push_back({{2, 1, 0}, 0.7, 4, ""});
  EXPECT_EQ(void_in(s), 5u) << "the larger one";
  s.spheres[5].radius = 1;
  EXPECT_EQ(void_in(s), 4u);
  s.spheres[5] = {{2, 1, 1e-9}, 0.7, 4, ""};
  EXPECT_EQ(void_in(s), 4u);
  s.spheres[5] = {{2, 1, 0}, 0.7, 4, ""};
  s.materials[4].model = scene::Dielectric{0.7};
  EXPECT_EQ(void_in(s), 4u) << "another index";
}

TEST(CompileCausticList, VoidsMoveWithTheirBalls) {
  scene::Scene opening = stage();
  opening.spheres.push_back({{2, 1, 0}, -0.5, 2, ""});
  scene::Scene closing = opening;
  closing.spheres[2].center = closing.spheres[4].center = {3, 1, 0};
  EXPECT_EQ(void_in(opening, &closing), 4u);
  closing.spheres[4].radius = -1;
  EXPECT_EQ(void_in(opening, &closing), kernel::kNone);
  closing.spheres[4] = {{3, 1, 0.1}, -0.5, 2, ""};
  EXPECT_EQ(void_in(opening, &closing), kernel::kNone);
}

TEST(CompileCausticList, LightsThatTouchABallDuringTheShutterAreLeftOut) {
  const scene::Scene opening = stage();
  scene::Scene closing = opening;
  closing.spheres[3].center = {3, 1.2, 0};  // through the glass ball
  EXPECT_EQ(listed_in(compile(opening, &closing)), 1u);
  closing.spheres[3].center = {4, 6, 0};
  EXPECT_EQ(listed_in(compile(opening, &closing)), 2u);
}

TEST(CompileCausticList, FastLeavesOutSmallLights) {
  scene::Scene s = stage();
  s.spheres[3].radius = 0.004;
  EXPECT_EQ(listed_in(compile(s)), 2u);
  s.render.precision = scene::Precision::kFast;
  EXPECT_EQ(listed_in(compile(s)), 0u);
}

TEST(CompileCausticList, FollowsChangesOfPrecisionAndDirectLighting) {
  CompiledScene compiled = compile(stage());
  compiled.direct_lighting = kernel::DirectLighting::kBsdf;
  update_lights(compiled);
  EXPECT_FALSE(compiled.features.caustics);
  compiled.direct_lighting = kernel::DirectLighting::kMis;
  update_lights(compiled);
  EXPECT_EQ(listed_in(compiled), 2u);
}

/// Balls that differ in radius, and lamps, in a grid.
CausticList list_of_many(int balls, int lamps, double growth, double height = 9) {
  scene::Scene s = stage();
  s.spheres.resize(1);
  double radius = 1e-3;
  for (int i = 0; i < balls; ++i, radius *= growth)
    s.spheres.push_back({{3.0 * (i % 32), 1, 3.0 * (i / 32)}, radius, 2, ""});
  for (int i = 0; i < lamps; ++i) s.spheres.push_back({{3.0 * (i % 32), height, 3.0 * (i / 32)}, 0.5, 3, ""});
  return compile(s).caustics;
}

TEST(CompileCausticList, AThousandBallsAndAThousandLampsAreBounded) {
  const CausticList list = list_of_many(1000, 1000, 1.006);
  EXPECT_EQ(list.pairs, 1'000'000u);
  ASSERT_EQ(list.balls.size(), kernel::Caustics::kMaxBalls);
  for (std::size_t i = 1; i < list.balls.size(); ++i) EXPECT_LT(list.balls[i - 1].sphere, list.balls[i].sphere);
  for (const kernel::CausticBall& ball : list.balls) EXPECT_LE(ball.end - ball.begin, kMaxCausticLights);
}

TEST(CompileCausticList, TheStrongestBallsAreKept) {
  const CausticList list = list_of_many(1000, 1, 1.006, 1e4);  // they differ in little but their radius
  ASSERT_EQ(list.balls.size(), 128u);
  for (std::uint32_t i = 0; i < 128; ++i) EXPECT_EQ(list.balls[i].sphere, 1 + 1000 - 128 + i);
  EXPECT_EQ(list.bytes(), 128 * (sizeof(kernel::CausticBall) + sizeof(kernel::CausticLight)));
}

TEST(CompileCausticList, CanBeStopped) {
  compile::CompiledScene compiled = compile(stage());
  std::atomic<bool> is_stopped = false;
  const base::StopScope scope(&is_stopped);
  EXPECT_GT(caustic_list(compiled.view(), compiled.precision).balls.size(), 0u);
  is_stopped = true;
  EXPECT_THROW(caustic_list(compiled.view(), compiled.precision), base::Error);
}

TEST(CompileCausticList, EqualBallsBeyondTheLimitAreLeftOut) {
  EXPECT_EQ(list_of_many(1000, 1, 1, 1e4).balls.size(), 0u);
  EXPECT_EQ(list_of_many(128, 1, 1, 1e4).balls.size(), 128u);
}

TEST(CompileCausticList, ScalingByAPowerOfTwoChangesNothing) {
  for (const double scale : {0x1p-36, 0x1p36}) {
    scene::Scene s = stage();
    for (scene::Sphere& sphere : s.spheres) {
      sphere.center = sphere.center * scale;
      sphere.radius *= scale;
    }
    const CausticList small = compile(stage()).caustics, large = compile(s).caustics;
    ASSERT_EQ(large.balls.size(), small.balls.size());
    for (std::size_t i = 0; i < small.balls.size(); ++i)
      EXPECT_EQ(large.balls[i].power, small.balls[i].power * scale * scale);
  }
}

}  // namespace
}  // namespace orrery::compile
