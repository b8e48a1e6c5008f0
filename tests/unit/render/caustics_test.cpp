// SPDX-License-Identifier: Apache-2.0
// Sampled caustics within the path loop: depth, and layers.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "film/layers.h"
#include "film/picture.h"
#include "render/render.h"
#include "render/result.h"
#include "render/settings.h"
#include "scene/scene.h"
#include "support/lit_scenes.h"

namespace orrery::render {
namespace {

/// A glass ball between a lamp above and the floor.
scene::Scene ball_below_a_lamp() {
  scene::Scene s = test::dark_stage(8, 8);
  s.spheres.pop_back();
  test::add_ball(s, {0, 2, 0}, 1, scene::Dielectric{1.5, scene::Fresnel::kExact});
  test::add_lamp(s, {0, 6, 0}, 0.3, {50, 50, 50});
  s.camera.look_from = {6, 1, 0};
  s.camera.vfov = 3;
  s.render.samples = 16;
  return s;
}

float brightest(const scene::Scene& scene) {
  const Result result = render(compile::compile(scene), {});
  const std::vector<float>& values = result.picture.planes[0].values;
  return *std::max_element(values.begin(), values.end());
}

TEST(RenderCaustics, ChainsThatExceedTheDepthAreNotSampled) {
  scene::Scene umbra = ball_below_a_lamp();  // where only two refractions lead to the lamp
  umbra.camera.look_at = {0, 0, 0};
  umbra.render.max_depth = 3;
  EXPECT_EQ(brightest(umbra), 0);
  umbra.render.max_depth = 4;
  EXPECT_GT(brightest(umbra), 0);
  scene::Scene core = ball_below_a_lamp();
  core.camera.look_from.y = core.camera.look_at.y = 2;
  core.spheres.erase(core.spheres.begin());  // the floor, which the ball reflects
  test::add_ball(core, {0, 2, 0}, 0.5, scene::Lambertian{{0.5, 0.5, 0.5}});
  core.render.max_depth = 3;
  EXPECT_EQ(brightest(core), 0);
  core.render.max_depth = 4;
  EXPECT_GT(brightest(core), 0);
}

/// Vertices that carry little are sampled rarely, and weigh more.
TEST(RenderCaustics, ADarkFloorReflectsItsShareOfTheLight) {
  scene::Scene s = ball_below_a_lamp();
  s.camera.look_at = {0, 0, 0};
  s.render.max_depth = 4;
  s.render.samples = 1024;
  const auto share = [&](double albedo) {
    s.materials[0].model = scene::Lambertian{{albedo, albedo, albedo}};
    const std::vector<float> values = render(compile::compile(s), {}).picture.planes[0].values;
    return std::accumulate(values.begin(), values.end(), 0.0) / albedo;
  };
  const double of_bright = share(0.25);
  EXPECT_GT(of_bright, 0);
  EXPECT_NEAR(share(0.02), of_bright, 0.05 * of_bright);
}

/// As if a path had found it.
TEST(RenderCaustics, AreIndirectLight) {
  scene::Scene s = ball_below_a_lamp();
  s.camera.look_at = {0, 1, 0};
  s.camera.vfov = 40;
  Settings settings;
  settings.layers.diffuse = true;
  const auto sum = [&](bool caustics, const char* name) {
    s.render.caustics = caustics;
    const Result result = render(compile::compile(s), settings);
    const film::Plane* const found = result.picture.find(name);
    EXPECT_NE(found, nullptr);
    return found != nullptr ? std::accumulate(found->values.begin(), found->values.end(), 0.0) : 0;
  };
  const double direct = sum(false, "diffuse_direct.R");
  EXPECT_NEAR(sum(true, "diffuse_direct.R"), direct, 1e-5 * direct);
  EXPECT_GT(sum(true, "diffuse_indirect.R"), 0.1 * direct);
}

}  // namespace
}  // namespace orrery::render
