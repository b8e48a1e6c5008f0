// SPDX-License-Identifier: Apache-2.0
#include "render/traversals.h"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "accel/accel.h"
#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "render/render.h"
#include "render/result.h"
#include "render/settings.h"
#include "support/everything.h"
#include "support/plane_values.h"

namespace orrery::render {
namespace {

std::vector<float> pixels_by(const scene::Scene& scene, std::optional<accel::Traversal> traversal) {
  Settings settings;
  settings.traversal = traversal;
  const Result result = render(compile::compile(scene), settings);
  return test::plane_values(result.picture);
}

TEST(RenderTraversals, AllGiveTheSameBits) {
  for (const auto precision : {scene::Precision::kExact, scene::Precision::kFast}) {
    scene::Scene scene = test::everything();
    scene.render.precision = precision;
    const auto packet = pixels_by(scene, accel::Traversal::kPacket);
    EXPECT_EQ(pixels_by(scene, accel::Traversal::kSingle), packet) << static_cast<int>(precision);
    EXPECT_EQ(pixels_by(scene, std::nullopt), packet) << static_cast<int>(precision);
  }
}

TEST(RenderTraversals, RequestedTraversalIsUsed) {
  const compile::CompiledScene compiled = compile::compile(test::everything());
  Settings settings;
  settings.traversal = accel::Traversal::kSingle;
  EXPECT_EQ(render(compiled, settings).statistics.traversal, "single");
  settings.traversal = accel::Traversal::kPacket;
  EXPECT_EQ(render(compiled, settings).statistics.traversal, "packet");
}

TEST(RenderTraversals, NamesDescribeBothKindsOfRays) {
  using enum accel::Traversal;
  EXPECT_EQ(name_of({kPacket, kPacket}), "packet");
  EXPECT_EQ(name_of({kSingle, kSingle}), "single");
  EXPECT_EQ(name_of({kPacket, kSingle}), "packet, secondary single");
}

/// Small spheres on a grid; the scene has too few paths for a trial.
scene::Scene balls(int count) {
  scene::Scene scene = test::everything();
  scene.spheres.clear();
  for (int i = 0; i < count; ++i) {
    const double x = i % 20, y = i / 20 % 20, z = i / 400;
    scene.spheres.push_back({{x - 10, y - 10, -z - 5}, 0.2, 0, ""});
  }
  return scene;
}

TEST(RenderTraversals, WithoutATrialTheSphereCountDecides) {
  for (const auto& [count, name] : {std::pair{900, "packet"}, std::pair{4000, "packet, secondary single"}}) {
    const compile::CompiledScene compiled = compile::compile(balls(count));
    const std::unique_ptr<accel::Accel> accel = build(compiled, 1);
    EXPECT_EQ(name_of(choose_traversals(compiled, *accel, std::nullopt)), name);
  }
}

/// With enough samples for a trial, the result is one of the four combinations, whichever is faster.
TEST(RenderTraversals, TrialChoosesATraversal) {
  scene::Scene scene = balls(4000);
  scene.render.samples = 4096;
  const compile::CompiledScene compiled = compile::compile(scene);
  const std::unique_ptr<accel::Accel> accel = build(compiled, 1);
  const std::string name = name_of(choose_traversals(compiled, *accel, std::nullopt));
  EXPECT_TRUE(name == "packet" || name == "single" || name == "packet, secondary single" ||
              name == "single, secondary packet")
      << name;
}

/// Few enough spheres and enough samples for a trial of structures.
TEST(RenderTraversals, TrialOfStructuresChangesNoBit) {
  scene::Scene scene = balls(2000);
  scene.image = {64, 36};
  compile::CompiledScene compiled = compile::compile(scene);
  compiled.samples = 1 << 20;
  const std::unique_ptr<accel::Accel> accel = build(compiled, 1);
  compiled.samples = 4;
  const auto separate = accel::make_embree(compiled.view(), compiled.precision, {}, accel::kNoBvh);
  const auto many = accel::make_embree(compiled.view(), compiled.precision, {}, 1);
  ASSERT_NE(separate->bytes(), many->bytes());
  EXPECT_TRUE(accel->bytes() == separate->bytes() || accel->bytes() == many->bytes());
  const auto pixels = [&](accel::Accel& a) { return test::plane_values(render(compiled, a, {}).picture); };
  EXPECT_EQ(pixels(*accel), pixels(*separate));
  EXPECT_EQ(pixels(*accel), pixels(*many));
}

}  // namespace
}  // namespace orrery::render
