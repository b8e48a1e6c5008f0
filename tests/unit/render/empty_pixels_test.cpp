// SPDX-License-Identifier: Apache-2.0
#include "render/empty_pixels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "film/sums.h"
#include "render/render.h"
#include "render/result.h"
#include "render/settings.h"
#include "render/tiles.h"
#include "support/front_view.h"
#include "support/plane_values.h"

namespace orrery::render {
namespace {

/// Small spheres and rods in front of a white background.
scene::Scene figure() {
  scene::Scene s = test::front_view(70, 50, {1, 0.75, 0.5});
  s.camera.look_from = {0.5, 0.7, 9};
  s.camera.look_at.x = 0.2;
  s.render.samples = 64;
  s.materials = {{"grey", scene::Lambertian{{0.5, 0.5, 0.5}}}};
  std::mt19937 random(4);
  const auto number = [&](double most) { return std::uniform_real_distribution<double>(-most, most)(random); };
  for (int i = 0; i < 12; ++i) {
    scene::Sphere sphere;
    sphere.center = {number(4), number(2), number(4)};
    sphere.radius = 0.2 + 0.1 * number(1);
    s.spheres.push_back(sphere);
    scene::Rod rod;
    rod.from = sphere.center;
    rod.to = sphere.center + math::Vec3d{number(1), number(1), number(1)};
    rod.radius = 0.05;
    s.rods.push_back(rod);
  }
  return s;
}

std::vector<bool> find(const compile::CompiledScene& compiled) {
  TilePool pool(2);
  return find_empty_pixels(compiled, {}, pool);
}

/// The pixels in which a path hits an object. With layers of hits, empty pixels are rendered like all others.
std::vector<bool> hit_pixels(const compile::CompiledScene& compiled) {
  Settings settings;
  settings.layers.z = true;
  const Result result = render(compiled, settings);
  std::vector<bool> out;
  for (const std::uint32_t hit : result.sums->layers.hit) out.push_back(hit != 0);
  return out;
}

TEST(RenderEmptyPixels, NoPathHitsAnObjectThere) {
  const std::vector<std::pair<std::string, std::function<void(scene::Scene&, scene::Scene&)>>> changes = {
      {"pinhole", [](scene::Scene&, scene::Scene&) {}},
      {"filter", [](scene::Scene& s, scene::Scene&) { s.render.filter = scene::Filter::kGaussian; }},
      {"lens", [](scene::Scene& s, scene::Scene&) { s.camera.defocus_angle = 3; }},
      {"lens, near focus",
       [](scene::Scene& s, scene::Scene&) { s.camera.defocus_angle = 2, s.camera.focus_distance = 2; }},
      {"orthographic", [](scene::Scene& s, scene::Scene&) { test::make_orthographic(s); }},
      {"wide",
       [](scene::Scene& s, scene::Scene&) {
         s.camera.vfov = 120;
         s.camera.look_from.z = 6;
       }},
      {"motion", [](scene::Scene&, scene::Scene& closing) { closing.spheres[0].center.x += 2; }},
      {"one behind", [](scene::Scene& s, scene::Scene&) { s.spheres[0].center.z = 20; }},
  };
  for (const auto& [name, change] : changes) {
    scene::Scene opening = figure(), closing = opening;
    change(opening, closing);
    closing.camera = opening.camera;
    closing.render = opening.render;
    if (name != "motion") closing.spheres = opening.spheres;
    const compile::CompiledScene compiled = compile::compile(opening, name == "motion" ? &closing : nullptr);
    const std::vector<bool> empty = find(compiled), hit = hit_pixels(compiled);
    ASSERT_EQ(empty.size(), hit.size()) << name;
    for (std::size_t i = 0; i < hit.size(); ++i) EXPECT_FALSE(empty[i] && hit[i]) << name << ", pixel " << i;
    EXPECT_GT(std::count(empty.begin(), empty.end(), true), std::count(hit.begin(), hit.end(), false) / 2) << name;
  }
}

TEST(RenderEmptyPixels, NoneAreFoundWhereTheyWouldDiffer) {
  scene::Scene gradient = figure(), around = figure(), turned = figure();
  EXPECT_FALSE(find(compile::compile(gradient)).empty());
  gradient.background.type = scene::BackgroundType::kGradient;
  gradient.background.top = {0, 0, 1};
  EXPECT_TRUE(find(compile::compile(gradient)).empty()) << "the background differs";
  around.spheres[0].center = around.camera.look_from;
  around.spheres[0].radius = 100;
  EXPECT_TRUE(find(compile::compile(around)).empty()) << "a sphere contains the camera";
  turned.camera.look_at.x = 1;
  const scene::Scene opening = figure();
  EXPECT_TRUE(find(compile::compile(opening, &turned)).empty()) << "the camera moves";
}

/// Sums, and what is computed from them, do not depend on whether empty pixels are rendered.
TEST(RenderEmptyPixels, TheirSumsAreThoseOfTracedPaths) {
  for (const bool is_adaptive : {false, true}) {
    for (const auto precision : {scene::Precision::kExact, scene::Precision::kFast}) {
      scene::Scene s = figure();
      s.render.precision = precision;
      const compile::CompiledScene compiled = compile::compile(s);
      Settings settings;
      settings.layers.halves = settings.layers.coverage = true;
      if (is_adaptive) settings.noise = 0.05;
      const Result known = render(compiled, settings);
      settings.layers.z = true;
      const Result traced = render(compiled, settings);
      ASSERT_TRUE(known.sums->empty.is_known());
      ASSERT_FALSE(traced.sums->empty.is_known());
      std::vector<float> all = test::plane_values(traced.picture);
      const std::vector<float> values = test::plane_values(known.picture);
      const auto pixels = static_cast<std::ptrdiff_t>(known.sums->pixel_count());
      all.erase(all.begin() + 4 * pixels, all.begin() + 5 * pixels);  // Z
      EXPECT_EQ(values, all);
      EXPECT_EQ(known.picture.coverage, traced.picture.coverage);
      EXPECT_EQ(known.statistics.rays, traced.statistics.rays);
      EXPECT_EQ(known.statistics.paths, traced.statistics.paths) << is_adaptive;
      EXPECT_EQ(known.sums->counts, traced.sums->counts);
      EXPECT_EQ(known.sums->largest, traced.sums->largest);

      // A render that continues from a file has the same sums.
      film::Sums read = film::from_words(film::to_words(*known.sums), compiled.width, compiled.height);
      EXPECT_FALSE(read.empty.is_known());
      settings.layers.z = false;
      const Result resumed = render(compiled, settings, std::move(read));
      EXPECT_EQ(test::plane_values(resumed.picture), values);
    }
  }
}

}  // namespace
}  // namespace orrery::render
