// SPDX-License-Identifier: Apache-2.0
#include "render/seen_emitters.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
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

/// The number of pixels of each lamp, and of each ball that reflects one.
std::vector<int> seen_pixels(const compile::CompiledScene& compiled) {
  const SeenEmitterList list(compiled.view(), compiled.precision, compiled.width, compiled.height);
  const kernel::SeenEmitters seen = list.view();
  std::vector<int> out(compiled.view().sphere_count);
  if (seen.begins == nullptr) return out;
  for (int y = 0; y < compiled.height; ++y)
    for (int x = 0; x < compiled.width; ++x) {
      float before = 0;
      for (const kernel::SeenEmitter& e : seen.at({x, y})) {
        ++out[e.ball == kernel::kCamera ? e.id : e.ball];
        EXPECT_GT(e.share_end, before);
        EXPECT_TRUE(seen.has({e.ball, e.id}) && seen.has({x, y}, {e.ball, e.id}));
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

/// A rectangle around the pixels that have lamps in balls.
scene::Window pixels_of_glints(const compile::CompiledScene& compiled) {
  const SeenEmitterList list(compiled.view(), compiled.precision, compiled.width, compiled.height);
  const kernel::SeenEmitters seen = list.view();
  int left = compiled.width, right = 0, top = compiled.height, bottom = 0;
  for (int y = 0; seen.begins != nullptr && y < compiled.height; ++y)
    for (int x = 0; x < compiled.width; ++x)
      for (const kernel::SeenEmitter& e : seen.at({x, y})) {
        if (e.ball == kernel::kCamera) continue;
        left = std::min(left, x);
        right = std::max(right, x + 1);
        top = std::min(top, y);
        bottom = std::max(bottom, y + 1);
      }
  return {left, top, right - left, bottom - top};
}

/// A sharp ball with the image of a small lamp, of about a fifteenth of a pixel.
scene::Scene glint(const scene::MaterialModel& model) {
  scene::Scene s = test::front_view(48, 32);
  s.render.samples = 1024;
  s.render.max_depth = 3;
  test::add_lamp(s, {6, 4, 14}, 1.1, {1000, 700, 400}, "lamp");
  test::add_ball(s, {-0.6, 0.3, 0}, 0.9, model);
  return s;
}

const scene::Metal kMirror{{0.9, 0.7, 0.5}, 0};

/// The light in the image, red.
double light_of(const scene::Scene& s) {
  double sum = 0;
  const Result r = render(compile::compile(s), {});
  for (const float value : r.picture.planes[0].values) sum += static_cast<double>(value);
  return sum;
}

scene::Scene in_the_sun(scene::Scene s) {
  const auto map = std::make_shared<scene::LatLongMap>(32, 16);
  for (int y = 0; y < map->height(); ++y) std::fill_n(map->row(y), 3 * map->width(), 0.01f);
  map->sun.direction = math::normalized(math::Vec3d{6, 4, 14});
  map->sun.one_minus_cos = 2e-3;
  map->sun.radiance = {1000, 700, 400};
  s.background.type = scene::BackgroundType::kImage;
  s.background.image = map;
  s.spheres.erase(s.spheres.begin());
  return s;
}

/// Pictures of balls in which camera rays alone find lamps, and in which they are sampled.
TEST(RenderSeenEmitters, GlintsAreThoseOfCameraRays) {
  const auto changed = [](scene::Scene s, const auto& change) {
    change(s);
    return s;
  };
  const scene::Scene mirror = glint(kMirror);
  scene::Lambertian veil{{0, 0, 0}};
  veil.opacity = 0.5;
  const std::vector<std::pair<std::string, scene::Scene>> scenes = {
      {"mirror", mirror},
      {"glass", glint(scene::Dielectric{1.5, scene::Fresnel::kExact})},
      {"bubble", glint(scene::Dielectric{0.6})},
      {"coat", glint(scene::Plastic{{0.2, 0.2, 0.2}, 1.5, 0})},
      // Its base scatters to the lamp, which is not the image that is sampled.
      {"base below a coat", changed(glint(scene::Plastic{{0.9, 0.9, 0.9}, 1.5, 0}),
                                    [](scene::Scene& s) {
                                      s.spheres[0] = {{-0.6, 6, 3}, 5, 0, ""};
                                      s.spheres[1].radius = 0.1;
                                    })},
      {"sun", in_the_sun(mirror)},
      {"lens", changed(mirror,
                       [](scene::Scene& s) {
                         s.camera.defocus_angle = 0.5;
                         s.camera.focus_distance = 10;
                       })},
      {"filter", changed(mirror, [](scene::Scene& s) { s.render.filter = scene::Filter::kGaussian; })},
      {"wide pixels", changed(mirror, [](scene::Scene& s) { s.image.pixel_aspect = 2; })},
      {"lamp at the side", changed(mirror,
                                   [](scene::Scene& s) {
                                     s.spheres[0].center = {-9, 2, -5};
                                   })},
      {"close lamp", changed(mirror,
                             [](scene::Scene& s) {
                               s.spheres[0] = {{0.6, 0.9, 1}, 0.05, 0, ""};
                             })},
      {"hidden in part", changed(mirror,
                                 [](scene::Scene& s) {
                                   test::add_ball(s, {5.6, 3.47, 12}, 0.8, scene::Lambertian{{0, 0, 0}});
                                 })},
      {"veiled", changed(mirror,
                         [&](scene::Scene& s) {
                           test::add_ball(s, {5.06, 3.47, 12}, 1.3, veil);
                         })},
      {"ball behind a veil", changed(mirror,
                                     [&](scene::Scene& s) {
                                       test::add_ball(s, {-0.3, 0.1, 5}, 0.6, veil);
                                     })},
  };
  for (const auto& [name, original] : scenes) {
    scene::Scene s = original;
    s.image.crop = pixels_of_glints(compile::compile(s));
    ASSERT_TRUE(s.image.crop->width > 0 && s.image.crop->width < 8 && s.image.crop->height < 8) << name;
    const double sampled = light_of(s);
    s.render.direct_lighting = scene::DirectLighting::kBsdf;
    s.render.samples = 1 << 19;
    EXPECT_NEAR(sampled / light_of(s), 1, 0.05) << name;  // of glass, 1,500 hits of camera rays
  }
}

TEST(RenderSeenEmitters, OtherImagesInBallsAreLeftToCameraRays) {
  using Change = std::function<void(scene::Scene&)>;
  const std::vector<std::pair<std::string, Change>> changes = {
      {"large", [](scene::Scene& s) { s.spheres[0].radius = 4; }},
      {"fuzzy",
       [](scene::Scene& s) {
         s.materials[1].model = scene::Metal{{0.9, 0.9, 0.9}, 0.01};
       }},
      {"blurred",
       [](scene::Scene& s) {
         s.camera.defocus_angle = 10;
         s.camera.focus_distance = 4;
       }},
      {"single precision", [](scene::Scene& s) { s.render.precision = scene::Precision::kFast; }},
      {"short paths", [](scene::Scene& s) { s.render.max_depth = 1; }},
      {"in the ball",
       [](scene::Scene& s) {
         s.spheres[1] = {{0, 0, 10}, 1, 1, ""};
       }},
      {"touching",
       [](scene::Scene& s) {
         s.spheres[0] = {{-0.6, 0.3, 0.9}, 0.05, 0, ""};
       }},
  };
  for (const auto& [name, change] : changes) {
    scene::Scene s = glint(kMirror);
    EXPECT_GT(seen_pixels(compile::compile(s))[1], 0);
    change(s);
    EXPECT_EQ(seen_pixels(compile::compile(s))[1], 0) << name;
  }
  const scene::Scene s = glint(kMirror);
  scene::Scene closing = s;
  closing.spheres[1].center.x += 1;
  EXPECT_EQ(seen_pixels(compile::compile(s, &closing)), std::vector<int>(2)) << "the ball moves";
}

/// The image in a ball is specular light of the lamp's group.
TEST(RenderSeenEmitters, GlintsAreSpecular) {
  for (const scene::MaterialModel& model :
       {scene::MaterialModel{kMirror}, scene::MaterialModel{scene::Plastic{{0, 0, 0}, 1.5, 0}}}) {
    Settings settings;
    settings.layers.specular = settings.layers.light_groups = true;
    settings.layers.groups = {{"default", false, true}, {"lamp", true, false}};
    const Result r = render(compile::compile(glint(model)), settings);
    double light[3] = {};
    const std::string names[3] = {"R", "specular_direct.R", "lamp.R"};
    for (const film::Plane& p : r.picture.planes)
      for (int k = 0; k < 3; ++k)
        for (std::size_t i = 0; p.name == names[k] && i < p.values.size(); ++i)
          light[k] += static_cast<double>(p.values[i]);
    EXPECT_GT(light[0], 0);
    EXPECT_NEAR(light[1], light[0], 1e-5 * light[0]);
    EXPECT_NEAR(light[2], light[0], 1e-5 * light[0]);
  }
}

/// A glint of a thousandth of a pixel needs as few samples as the rest.
TEST(RenderSeenEmitters, GlintsNeedFewSamples) {
  scene::Scene s = glint(kMirror);
  s.background.color = {0.2, 0.2, 0.2};
  s.spheres[0].radius = 0.03;
  std::get<scene::Emitter>(s.materials[0].model).radiance = {1e5, 1e5, 1e5};
  Settings settings;
  settings.noise = 0.03;
  settings.unlimited = true;
  const Result sampled = render(compile::compile(s), settings);
  EXPECT_LT(sampled.statistics.paths, std::uint64_t{64} * 48 * 32);
  EXPECT_EQ(sampled.statistics.unreliable_pixels, 0u);
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
  for (scene::Scene s : {small_lamps(), glint(kMirror)}) {
    s.render.samples = 16;
    const std::vector<float> frame = render(compile::compile(s), {}).picture.planes[0].values;
    s.image.crop = scene::Window{20, 10, 20, 15};
    const std::vector<float> crop = render(compile::compile(s), {}).picture.planes[0].values;
    ASSERT_EQ(crop.size(), 300u);
    EXPECT_NE(crop, std::vector<float>(300, crop[0]));
    for (std::size_t y = 0; y < 15; ++y)
      for (std::size_t x = 0; x < 20; ++x) EXPECT_EQ(crop[20 * y + x], frame[48 * (y + 10) + x + 20]);
  }
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
