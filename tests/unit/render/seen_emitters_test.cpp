// SPDX-License-Identifier: Apache-2.0
#include "render/seen_emitters.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "film/picture.h"
#include "render/render.h"
#include "render/result.h"
#include "render/settings.h"
#include "support/front_view.h"
#include "support/lit_scenes.h"
#include "support/plane_values.h"

namespace orrery::render {
namespace {

/// A small lamp, and a blurred one in front of it, before a dim sky.
scene::Scene small_lamps() {
  scene::Scene s = test::front_view(48, 32, {0.1, 0.2, 0.3});
  s.camera.defocus_angle = 8;
  s.camera.focus_distance = 10;
  s.render.samples = 1024;
  test::add_lamp(s, {-2.13, 1.41, 0}, 0.06, {1000, 700, 400}, "far");
  test::add_lamp(s, {0.61, -0.33, 4}, 0.04, {3000, 3000, 3000}, "near");
  return s;
}

/// The number of pixels of each lamp.
std::vector<int> seen_pixels(const compile::CompiledScene& compiled) {
  const SeenEmitterList list(compiled.view(), compiled.precision, compiled.width, compiled.height);
  const kernel::SeenEmitters seen = list.view();
  std::vector<int> out(compiled.view().sphere_count);
  if (seen.begins == nullptr) return out;
  for (int y = 0; y < compiled.height; ++y)
    for (int x = 0; x < compiled.width; ++x) {
      float before = 0;
      for (const kernel::SeenEmitter& e : seen.at({x, y})) {
        ++out[e.id];
        EXPECT_GT(e.share_end, before);
        EXPECT_TRUE(seen.has(e.id) && seen.has({x, y}, e.id));
        before = e.share_end;
      }
      if (before > 0) {
        EXPECT_EQ(before, 1);
      }
    }
  return out;
}

TEST(RenderSeenEmitters, SmallAndBlurredOnesAreListed) {
  const std::vector<int> found = seen_pixels(compile::compile(small_lamps()));
  EXPECT_GT(found[0], 0);
  EXPECT_LT(found[0], 16);
  EXPECT_GT(found[1], 16);
  EXPECT_LT(found[1], 80);
}

TEST(RenderSeenEmitters, OthersAreLeftToCameraRays) {
  using Change = std::function<void(scene::Scene&)>;
  const std::vector<std::pair<std::string, Change>> changes = {
      {"large", [](scene::Scene& s) { s.spheres[0].radius = s.spheres[1].radius = 1; }},
      {"behind", [](scene::Scene& s) { s.spheres[0].center.z = s.spheres[1].center.z = 20; }},
      {"aside", [](scene::Scene& s) { s.spheres[0].center.x = s.spheres[1].center.x = 40; }},
      {"bsdf", [](scene::Scene& s) { s.render.direct_lighting = scene::DirectLighting::kBsdf; }},
      {"book", [](scene::Scene& s) { s.render.precision = scene::Precision::kBook; }},
      {"translucent",
       [](scene::Scene& s) {
         for (scene::Material& m : s.materials) std::get<scene::Emitter>(m.model).opacity = 0.5;
       }},
      {"orthographic", [](scene::Scene& s) { test::make_orthographic(s); }},
  };
  for (const auto& [name, change] : changes) {
    scene::Scene s = small_lamps();
    change(s);
    EXPECT_EQ(seen_pixels(compile::compile(s)), std::vector<int>(2)) << name;
  }
  const scene::Scene s = small_lamps();
  scene::Scene closing = s;
  closing.camera.look_at.x = 1;
  EXPECT_EQ(seen_pixels(compile::compile(s, &closing)), std::vector<int>(2)) << "the camera moves";
  closing = s;
  closing.spheres[0].center.x += 1;
  EXPECT_EQ(seen_pixels(compile::compile(s, &closing))[0], 0) << "the lamp moves";
}

/// Pictures of small_lamps() with camera rays alone, in which these lamps are rare, and with sampled lamps.
TEST(RenderSeenEmitters, LightIsThatOfCameraRays) {
  using Change = std::function<void(scene::Scene&)>;
  const std::vector<std::pair<std::string, Change>> changes = {
      {"lens", [](scene::Scene&) {}},
      {"pinhole", [](scene::Scene& s) { s.camera.defocus_angle = 0; }},
      {"filter", [](scene::Scene& s) { s.render.filter = scene::Filter::kGaussian; }},
      {"wide pixels", [](scene::Scene& s) { s.image.pixel_aspect = 2; }},
      {"hidden in part",
       [](scene::Scene& s) {
         test::add_ball(s, {0.75, -0.4, 5.5}, 0.2, scene::Lambertian{{0, 0, 0}});
       }},
      {"veiled",
       [](scene::Scene& s) {
         scene::Lambertian veil{{0, 0, 0}};
         veil.opacity = 0.5;
         test::add_ball(s, {0.75, -0.4, 5.5}, 0.4, veil);
       }},
      {"single precision", [](scene::Scene& s) { s.render.precision = scene::Precision::kFast; }},
  };
  for (const auto& [name, change] : changes) {
    scene::Scene s = small_lamps();
    change(s);
    double light[2] = {};
    for (const bool sampled : {false, true}) {
      s.render.direct_lighting = sampled ? scene::DirectLighting::kMis : scene::DirectLighting::kBsdf;
      s.render.samples = sampled ? 1 << 10 : 1 << 15;
      const Result r = render(compile::compile(s), {});
      for (const float value : r.picture.planes[0].values) light[sampled ? 1 : 0] += static_cast<double>(value) - 0.1;
    }
    EXPECT_NEAR(light[1] / light[0], 1, 0.04) << name;  // four standard errors of camera rays
  }
}

/// The sampled light is a part of the layers of emission and of its light group.
TEST(RenderSeenEmitters, LayersHaveTheirLight) {
  const scene::Scene s = small_lamps();
  Settings settings;
  settings.layers.emission = settings.layers.background = settings.layers.light_groups = true;
  settings.layers.groups = {{"default", false, true}, {"far", true, false}, {"near", true, false}};
  const Result r = render(compile::compile(s), settings);
  const auto plane = [&](const std::string& name) -> const std::vector<float>& {
    for (const film::Plane& p : r.picture.planes)
      if (p.name == name) return p.values;
    ADD_FAILURE() << name;
    return r.picture.planes[0].values;
  };
  double far = 0, near = 0;
  for (std::size_t i = 0; i < plane("R").size(); ++i) {
    const float beauty = plane("R")[i];
    EXPECT_NEAR(plane("emission.R")[i] + plane("background.R")[i], beauty, 1e-5f * beauty);
    EXPECT_NEAR(plane("far.R")[i] + plane("near.R")[i] + plane("default.R")[i], beauty, 1e-5f * beauty);
    far += static_cast<double>(plane("far.R")[i]);
    near += static_cast<double>(plane("near.R")[i]);
  }
  EXPECT_GT(far, 0);
  EXPECT_GT(near, 0);
}

TEST(RenderSeenEmitters, PixelsOfACropAreThoseOfTheFrame) {
  scene::Scene s = small_lamps();
  s.render.samples = 16;
  const std::vector<float> frame = render(compile::compile(s), {}).picture.planes[0].values;
  s.image.crop = scene::Window{20, 10, 20, 15};
  const std::vector<float> crop = render(compile::compile(s), {}).picture.planes[0].values;
  ASSERT_EQ(crop.size(), 300u);
  for (std::size_t y = 0; y < 15; ++y)
    for (std::size_t x = 0; x < 20; ++x) EXPECT_EQ(crop[20 * y + x], frame[48 * (y + 10) + x + 20]);
}

/// Neither the pixel of the small lamp nor those of the blurred one wait until camera rays have hit it.
TEST(RenderSeenEmitters, ATargetNoiseNeedsFewSamples) {
  scene::Scene s = small_lamps();
  s.spheres[0].radius = s.spheres[1].radius = 0.004;
  Settings settings;
  settings.noise = 0.03;
  settings.unlimited = true;
  const Result sampled = render(compile::compile(s), settings);
  s.render.direct_lighting = scene::DirectLighting::kBsdf;
  const Result found = render(compile::compile(s), settings);
  EXPECT_LT(20 * sampled.statistics.paths, found.statistics.paths);
  EXPECT_EQ(sampled.statistics.unreliable_pixels, 0u);
}

}  // namespace
}  // namespace orrery::render
