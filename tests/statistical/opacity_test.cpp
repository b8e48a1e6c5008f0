// SPDX-License-Identifier: Apache-2.0
// Opacity against closed forms: light that passes objects, and light that they emit.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "render/render.h"
#include "render/result.h"
#include "render/settings.h"
#include "scene/scene.h"

namespace orrery::test {
namespace {

constexpr double kLamp = 3;  ///< radiance
constexpr std::uint32_t kBlack = 0, kEmitter = 1, kOther = 2;
constexpr double kLargestMeanZ = 4;

/// A scene without a background, of pixels that all have the same expectation. Its first material is black and
/// translucent, the second an emitter.
scene::Scene dark_scene(double opacity) {
  scene::Scene s;
  s.image = {16, 16};
  s.camera.look_from = {0, 0, 0};
  s.camera.look_at = {0, 0, -1};
  s.camera.vfov = 1;
  s.background.type = scene::BackgroundType::kConstant;
  s.background.color = {0, 0, 0};
  s.render.samples = 256;
  s.render.roulette_depth = 0;
  s.materials = {{"black", scene::Lambertian{{0, 0, 0}}}, {"lamp", scene::Emitter{{kLamp, kLamp, kLamp}}}};
  std::get<scene::Lambertian>(s.materials[kBlack].model).opacity = opacity;
  return s;
}

/// Inside a large lamp.
scene::Scene lit_scene(double opacity) {
  scene::Scene s = dark_scene(opacity);
  s.spheres = {{{0, 0, 0}, 1000, kEmitter}};
  return s;
}

/// The image's mean, and its standard error from several seeds.
struct Mean {
  double value = 0, error = 0;
};

Mean mean_of(const scene::Scene& scene, std::size_t plane = 1, const film::LayerRequest& layers = {}) {
  constexpr int kMeanSeeds = 24;
  compile::CompiledScene compiled = compile::compile(scene);
  render::Settings settings;
  settings.layers = layers;
  std::vector<double> means;
  for (int seed = 0; seed < kMeanSeeds; ++seed) {
    compiled.sampler.seed = static_cast<std::uint32_t>(seed + 1);
    const render::Result result = render::render(compiled, settings);
    double sum = 0;
    for (const float v : result.picture.planes[plane].values) sum += static_cast<double>(v);
    means.push_back(sum / static_cast<double>(result.picture.planes[plane].values.size()));
  }
  Mean out;
  for (const double m : means) out.value += m / kMeanSeeds;
  for (const double m : means) out.error += (m - out.value) * (m - out.value);
  out.error = std::sqrt(out.error / (kMeanSeeds - 1) / kMeanSeeds);
  return out;
}

/// `bias`     relative error of the closed form
void expect_mean(const Mean& mean, double expected, const std::string& what, double bias = 0) {
  EXPECT_LT(std::abs(mean.value - expected), kLargestMeanZ * mean.error + bias * expected + 1e-6)
      << what << ": " << mean.value << " instead of " << expected << ", error " << mean.error;
  EXPECT_LT(mean.error, 0.02 * expected) << what;
}

void expect_mean(const scene::Scene& scene, double expected, const std::string& what, double bias = 0) {
  expect_mean(mean_of(scene), expected, what, bias);
}

TEST(StatisticalOpacity, CameraRaysPassASphereInFront) {
  for (const double opacity : {0.3, 0.5}) {
    scene::Scene s = lit_scene(opacity);
    s.spheres.push_back({{0, 0, -10}, 1, kBlack});
    expect_mean(s, (1 - opacity) * kLamp, "in front");
    s.spheres.push_back({{0, 0, -20}, 1, kBlack});
    expect_mean(s, (1 - opacity) * kLamp, "two deep");
    for (int i = 0; i < 3; ++i) s.spheres.push_back({{0, 0, -10 - 0.1 * i}, 2, kBlack});
    expect_mean(s, (1 - opacity) * kLamp, "five deep, nested");
    s.materials.push_back({"other", scene::Lambertian{{0, 0, 0}, {}, 0.6}});
    s.spheres.push_back({{0, 0, -30}, 1, kOther});
    expect_mean(s, 0.4 * kLamp, "one of another opacity");
  }
}

TEST(StatisticalOpacity, TheFarSideIsVisibleFromInside) {
  scene::Scene s = lit_scene(0.4);
  s.spheres.push_back({{0, 0, 0}, 5, kBlack});
  expect_mean(s, 0.6 * kLamp, "around the camera");
}

TEST(StatisticalOpacity, ScatteredRaysPassAShellAround) {
  for (const auto& [model, name] :
       {std::pair<scene::MaterialModel, const char*>{scene::Metal{{0.8, 0.8, 0.8}}, "mirror"},
        {scene::Lambertian{{0.8, 0.8, 0.8}}, "diffuse"}}) {
    scene::Scene s = lit_scene(0.5);
    s.materials.push_back({"ball", model});
    s.spheres.push_back({{0, 0, -10}, 1, kOther});
    // Around the ball, but not between it and the camera.
    s.spheres.push_back({{0, 0, -5}, 100, kBlack});
    expect_mean(s, 0.5 * 0.8 * kLamp, name);
  }
}

/// A floor under a lamp, seen from the side: the height of the lamp's centre, its radius, and the floor's albedo.
constexpr double kLampHeight = 10, kLampRadius = 1, kFloorAlbedo = 0.7;
constexpr double kLitFloor = kFloorAlbedo * kLamp * kLampRadius * kLampRadius / (kLampHeight * kLampHeight);

scene::Scene floor_scene(double opacity, scene::DirectLighting mode) {
  scene::Scene s = dark_scene(opacity);
  s.materials.push_back({"floor", scene::Lambertian{{kFloorAlbedo, kFloorAlbedo, kFloorAlbedo}}});
  s.camera.look_from = {20, 1, 0};
  s.camera.look_at = {0, 0, 0};
  s.camera.vfov = 0.02;
  s.render.direct_lighting = mode;
  s.render.max_depth = 3;
  s.spheres = {{{0, -1e5, 0}, 1e5, kOther}, {{0, kLampHeight, 0}, kLampRadius, kEmitter}};
  return s;
}

/// The floor is curved, and the camera sees a little of what is around its point below the lamp.
constexpr double kFloorBias = 1e-3;

TEST(StatisticalOpacity, ShadowsAreAsDarkAsTheirObjectIsOpaque) {
  for (const auto mode : {scene::DirectLighting::kMis, scene::DirectLighting::kLight, scene::DirectLighting::kBsdf}) {
    scene::Scene s = floor_scene(0.3, mode);
    if (mode == scene::DirectLighting::kBsdf) s.render.samples = 1024;
    expect_mean(s, kLitFloor, "without an object", kFloorBias);
    s.spheres.push_back({{0, 5, 0}, 2, kBlack});
    expect_mean(s, 0.7 * kLitFloor, "one object", kFloorBias);
    s.spheres.push_back({{0, 7, 0}, 1.5, kBlack});
    expect_mean(s, 0.7 * kLitFloor, "two objects", kFloorBias);
  }
}

TEST(StatisticalOpacity, LampsGiveLightInProportion) {
  for (const auto mode : {scene::DirectLighting::kMis, scene::DirectLighting::kLight, scene::DirectLighting::kBsdf}) {
    scene::Scene s = floor_scene(1, mode);
    if (mode == scene::DirectLighting::kBsdf) s.render.samples = 1024;
    std::get<scene::Emitter>(s.materials[kEmitter].model).opacity = 0.25;
    expect_mean(s, 0.25 * kLitFloor, "one lamp", kFloorBias);
    s.materials.push_back({"opaque lamp", scene::Emitter{{kLamp, kLamp, kLamp}}});
    s.spheres.push_back({{0, 2 * kLampHeight, 0}, kLampRadius, 3});  // its light passes the first
    expect_mean(s, (0.25 + 0.75 * 0.25) * kLitFloor, "two lamps", kFloorBias);
  }
  scene::Scene seen = dark_scene(1);
  std::get<scene::Emitter>(seen.materials[kEmitter].model).opacity = 0.25;
  seen.spheres.push_back({{0, 0, -10}, 1, kEmitter});
  expect_mean(seen, 0.25 * kLamp, "seen directly");
}

TEST(StatisticalOpacity, AlphaIsTheOpacity) {
  scene::Scene s = dark_scene(0.3);
  s.spheres.push_back({{0, 0, -10}, 1, kBlack});
  film::LayerRequest layers;
  layers.coverage = layers.transparent = true;
  expect_mean(mean_of(s, 3, layers), 0.3, "alpha of one object");
  s.spheres.push_back({{0, 0, -20}, 1, kBlack});
  expect_mean(mean_of(s, 3, layers), 0.3, "alpha of two objects");
}

/// Of objects of one opacity, the image is that with all of them and that without, mixed by the opacity: with their
/// shadows, reflections and light, and at all depths of the paths.
TEST(StatisticalOpacity, TheImageIsAMixtureOfThoseWithAndWithoutTheObjects) {
  const auto image = [](double opacity) {
    scene::Scene s = floor_scene(opacity, scene::DirectLighting::kMis);
    s.camera.vfov = 4;
    s.render.samples = 1024;
    s.render.max_depth = 6;
    s.background.color = {0.01, 0.02, 0.03};
    s.materials.push_back({"mirror", scene::Metal{{0.8, 0.8, 0.8}}});
    s.materials.push_back({"grey", scene::Lambertian{{0.1, 0.1, 0.1}, {}, opacity}});
    s.materials.push_back({"second lamp", scene::Emitter{{kLamp, kLamp, kLamp}, 0, "", {}, opacity}});
    s.spheres.push_back({{0, 1, 0}, 0.5, 3});
    s.spheres.push_back({{2, 0.5, 0.2}, 0.5, 4});
    s.spheres.push_back({{-1, 0.5, -0.2}, 0.8, 4});
    s.spheres.push_back({{0, 5, 1}, 1.5, 4});
    s.spheres.push_back({{3, 4, 2}, 1, 5});
    return mean_of(s);
  };
  const Mean with = image(1), without = image(0), mixed = image(0.3);
  EXPECT_GT(std::abs(with.value - without.value), 0.1 * without.value);
  expect_mean(mixed, 0.3 * with.value + 0.7 * without.value, "mixture", 2e-3);
}

/// White objects in a white environment cannot be seen, whatever the opacity.
TEST(StatisticalOpacity, EachPixelOfAFurnaceIsExact) {
  scene::Scene s = dark_scene(0.5);
  s.background.color = {1, 1, 1};
  s.camera.vfov = 30;
  s.materials[kBlack].model = scene::Lambertian{{1, 1, 1}, {}, 0.5};
  for (int i = 0; i < 30; ++i)
    s.spheres.push_back(
        {{std::sin(i), std::sin(1.7 * i), -5 + std::cos(2.3 * i)}, 0.5 + 0.3 * std::sin(3 * i), kBlack});
  s.spheres.push_back({{0, 0, -5}, 3, kBlack});
  s.render.max_depth = 200;
  for (const scene::Precision precision :
       {scene::Precision::kExact, scene::Precision::kFast, scene::Precision::kBook}) {
    s.render.precision = precision;
    const render::Result result = render::render(compile::compile(s), {});
    for (const float v : result.picture.planes[1].values) EXPECT_EQ(v, 1.0F);
  }
}

}  // namespace
}  // namespace orrery::test
