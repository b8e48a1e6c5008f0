// SPDX-License-Identifier: Apache-2.0
#include "render/reflections.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>

#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "support/front_view.h"
#include "support/lit_scenes.h"

namespace orrery::render {
namespace {

using math::Vec3d;

TEST(RenderReflections, ReflectionsObeyTheLawOfReflection) {
  std::mt19937 random(3);
  const auto number = [&] { return static_cast<double>(random()) * 0x1p-31 - 1; };
  int found = 0;
  for (int i = 0; i < 300; ++i) {
    const kernel::Sphere ball{number(), number(), number(), 0.5}, light{8 * number(), 8 * number(), 8 * number(), 0.1};
    const Vec3d eye{5 * number(), 5 * number(), 5 * number()};
    const auto seen = reflection_of(light, ball, eye, 30);
    if (!seen) continue;
    ++found;
    EXPECT_NEAR(length(seen->point), ball.radius, 1e-9);
    const Vec3d at = center_of(ball) + seen->point, normal = normalized(seen->point), to_eye = normalized(eye - at),
                to_light = normalized(center_of(light) - at);
    EXPECT_NEAR(length(to_eye + to_light - normal * (2 * dot(normal, to_eye))), 0, 1e-6);
    EXPECT_NEAR(seen->cosine, dot(normal, to_eye), 1e-6);
    EXPECT_NEAR(length(normalized(center_of(seen->image) - eye) + to_eye), 0, 1e-6) << "it is seen at this point";
  }
  EXPECT_GT(found, 100);
}

/// A small mirror images distant lights at half its radius.
TEST(RenderReflections, DistantLightsAreAtTheFocus) {
  const kernel::Sphere ball{0, 0, 0, 1}, light{0, 0, 1000, 10};
  const auto seen = reflection_of(light, ball, {0, 0, 500}, 20);
  ASSERT_TRUE(seen);
  EXPECT_NEAR(seen->image.z, 0.5, 0.01);
  EXPECT_NEAR(seen->image.radius, 0.005, 0.0001);
  EXPECT_FALSE(reflection_of(light, ball, {0, 0, 0.5}, 20)) << "the eye is in the ball";
  EXPECT_FALSE(reflection_of({0, 0, 1, 0.5}, ball, {0, 0, 5}, 20)) << "the light touches the ball";
}

/// Thousands of balls and lamps are not all paired.
TEST(RenderReflections, TheStrongestLightsAreReflected) {
  scene::Scene s = test::front_view(8, 8);
  s.materials.push_back({"mirror", scene::Metal{{0.8, 0.8, 0.8}, 0}});
  s.materials.push_back({"brushed", scene::Metal{{0.8, 0.8, 0.8}, 0.1}});
  for (unsigned i = 0; i < 2048; ++i) s.spheres.push_back({{i % 64 * 0.1, i / 64 * 0.1, -5}, 0.03, i % 2, ""});
  for (int i = 0; i < 300; ++i) test::add_lamp(s, {0.1 * i, 0, 5}, i % 3 == 0 ? 0.02 : 0.01, {1, 1, 1});
  const compile::CompiledScene compiled = compile::compile(s);
  EXPECT_EQ(count_sharp_balls(compiled.view()), 1024u);
  const auto lights = reflected_lights(compiled.view(), 1024);
  ASSERT_EQ(lights.size(), 256u);
  int strong = 0;
  for (const ReflectedLight& light : lights) strong += light.sphere[0].radius > 0.015 ? 1 : 0;
  EXPECT_EQ(strong, 100);
}

TEST(RenderReflections, SharpSurfacesReflectByTheirMaterial) {
  scene::Scene s = test::front_view(8, 8);
  test::add_lamp(s, {0, 0, 5}, 0.1, {1, 1, 1});
  test::add_ball(s, {0, 0, 0}, 1, scene::Metal{{0.2, 0.4, 0.6}, 0});
  test::add_ball(s, {3, 0, 0}, 1, scene::Dielectric{1.5});
  test::add_ball(s, {6, 0, 0}, 1, scene::Plastic{{0.5, 0.5, 0.5}, 1.5, 0});
  const compile::CompiledScene compiled = compile::compile(s);
  EXPECT_NEAR(sharp_reflectance(compiled.view(), 1, 0.3), 0.4, 1e-12);
  for (const std::uint32_t id : {2u, 3u}) {
    EXPECT_NEAR(sharp_reflectance(compiled.view(), id, 1), 0.04, 1e-12);
    EXPECT_NEAR(sharp_reflectance(compiled.view(), id, 0), 1, 1e-12);
  }
}

}  // namespace
}  // namespace orrery::render
