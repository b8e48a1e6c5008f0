// SPDX-License-Identifier: Apache-2.0
// Image textures with mip maps, rendered.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "compile/mip_map.h"
#include "render/render.h"
#include "scene/lat_long_map.h"
#include "scene/texture.h"
#include "support/plane_values.h"

namespace orrery::render {
namespace {

using Image = std::shared_ptr<const scene::LatLongMap>;

/// A map of 1024 x 512 texels, each 0 or 1, alternating or at random.
Image map(bool has_levels, bool is_random = false) {
  const auto out = std::make_shared<scene::LatLongMap>(1024, 512);
  std::mt19937 random{9};
  for (int y = 0; y < out->height(); ++y)
    for (int x = 0; x < out->width(); ++x) {
      const float value = is_random ? static_cast<float>(random() % 2) : static_cast<float>((x + y) % 2);
      for (int c = 0; c < 3; ++c) out->row(y)[3 * x + c] = value;
    }
  if (has_levels) compile::add_mip_map(*out);
  return out;
}

scene::TextureSlot texture_of(const Image& image) {
  scene::Texture texture;
  texture.type = scene::TextureType::kImage;
  texture.image = image;
  return std::make_shared<const scene::Texture>(texture);
}

/// A textured sphere that fills the image, with 20 texels to a pixel in its centre if it is 16 pixels wide, seen flat.
scene::Scene far_sphere(const Image& image, int width = 16) {
  scene::Scene s;
  s.image = {width, width};
  s.camera.look_from = {0, 0, 100};
  s.camera.look_at = {0, 0, 0};
  s.camera.vfov = 2 * std::atan(0.01) * 180 / 3.14159265358979;
  s.render.samples = 1;
  s.render.shading = scene::Shading::kFlat;
  s.materials = {{"map", scene::Lambertian{{1, 1, 1}, texture_of(image)}}};
  s.spheres = {{{0, 0, 0}, 1, 0, ""}};
  s.background.type = scene::BackgroundType::kConstant;
  s.background.color = {0.5, 0.5, 0.5};
  return s;
}

/// Mean and standard deviation of the first plane over the square in the image's centre that is half as wide.
struct Spread {
  double mean = 0, deviation = 0;
};
Spread spread_of(const scene::Scene& scene) {
  const Result result = render(compile::compile(scene), {});
  EXPECT_TRUE(result.completed);
  const film::Picture& p = result.picture;
  double sum = 0, squares = 0;
  int count = 0;
  for (int y = p.height / 4; y < p.height * 3 / 4; ++y)
    for (int x = p.width / 4; x < p.width * 3 / 4; ++x, ++count) {
      const auto v = static_cast<double>(
          p.planes[0]
              .values[static_cast<std::size_t>(y) * static_cast<std::size_t>(p.width) + static_cast<std::size_t>(x)]);
      sum += v;
      squares += v * v;
    }
  const double mean = sum / count;
  return {mean, std::sqrt(std::max(squares / count - mean * mean, 0.0))};
}

TEST(RenderTextureFiltering, AMinifiedCheckerIsItsMeanWithOneSample) {
  constexpr int kWidth = 8;  // a cone covers 2.5 texels
  EXPECT_GT(spread_of(far_sphere(map(false), kWidth)).deviation, 0.1) << "aliasing without levels";
  const Spread filtered = spread_of(far_sphere(map(true), kWidth));
  EXPECT_NEAR(filtered.mean, 0.5, 1e-3);
  EXPECT_LT(filtered.deviation, 0.01);
}

TEST(RenderTextureFiltering, OrthographicAndDefocusedCamerasFilterAsWell) {
  scene::Scene s = far_sphere(map(true), 8);
  s.camera.projection = scene::Projection::kOrthographic;
  s.camera.width = 2;
  EXPECT_LT(spread_of(s).deviation, 0.01);
  // A near sphere, magnified, so that only the lens can blur it.
  s = far_sphere(map(true));
  s.camera.look_from = {0, 0, 3};
  s.camera.vfov = 1;
  s.camera.focus_distance = 3;
  s.camera.defocus_angle = 20;
  const double in_focus = spread_of([&] {
                            s.camera.focus_distance = 2;
                            return s;
                          }())
                              .deviation;
  s.camera.focus_distance = 1;
  EXPECT_LT(spread_of(s).deviation, 0.5 * in_focus);
}

TEST(RenderTextureFiltering, FilteringKeepsTheMeanOfRandomTexels) {
  scene::Scene plain = far_sphere(map(false, true)), filtered = far_sphere(map(true, true));
  plain.render.samples = filtered.render.samples = 1024;
  const Spread a = spread_of(plain), b = spread_of(filtered);
  EXPECT_NEAR(a.mean, b.mean, 3e-3);
  EXPECT_NEAR(b.deviation, a.deviation, 0.3 * a.deviation) << "differences between pixels remain";
}

/// A white diffuse or mirror sphere in the middle of a sphere whose map emits.
scene::Scene inside_of_lamp(const Image& image, const scene::MaterialModel& model) {
  scene::Scene s = far_sphere(image);
  scene::Emitter lamp;
  lamp.radiance_texture = texture_of(image);
  s.render.shading = scene::Shading::kPath;
  s.render.max_depth = 2;
  s.render.samples = 4;
  s.materials = {{"lamp", lamp}, {"ball", model}};
  s.spheres = {{{0, 0, 0}, 1000, 0, ""}, {{0, 0, 0}, 1, 1, ""}};
  return s;
}

TEST(RenderTextureFiltering, DiffuseFuzzyAndCurvedSurfacesWidenTheCone) {
  const scene::MaterialModel models[] = {scene::Lambertian{{1, 1, 1}}, scene::Metal{{1, 1, 1}, 0.5},
                                         scene::Metal{{1, 1, 1}, 0}};
  for (const auto& model : models) {
    const Spread plain = spread_of(inside_of_lamp(map(false), model));
    const Spread filtered = spread_of(inside_of_lamp(map(true), model));
    EXPECT_GT(plain.deviation, 0.05) << model.index();
    EXPECT_LT(filtered.deviation, 0.02) << model.index();
    EXPECT_NEAR(filtered.mean, 0.5, 0.01) << model.index();
  }
}

TEST(RenderTextureFiltering, ANearSphereHasTheBitsOfBilinearInterpolation) {
  for (const auto precision : {scene::Precision::kExact, scene::Precision::kFast, scene::Precision::kBook}) {
    scene::Scene plain = far_sphere(map(false, true)), filtered = far_sphere(map(true, true));
    for (scene::Scene* s : {&plain, &filtered}) {
      s->camera.look_from = {0, 0, 1.1};
      s->render.precision = precision;
      s->render.samples = 8;
    }
    const auto values = [](const scene::Scene& s) {
      return test::plane_values(render(compile::compile(s), {}).picture);
    };
    EXPECT_EQ(values(plain), values(filtered));
    filtered.camera.look_from = plain.camera.look_from = {0, 0, 100};
    EXPECT_NE(values(plain), values(filtered));
  }
}

TEST(RenderTextureFiltering, EveryAcceleratorAndThreadCountGivesTheSameBits) {
  for (const auto precision : {scene::Precision::kExact, scene::Precision::kFast, scene::Precision::kBook}) {
    scene::Scene s = inside_of_lamp(map(true, true), scene::Metal{{1, 1, 1}, 0.2});
    s.render.precision = precision;
    s.render.max_depth = 8;
    s.spheres.push_back({{1.5, 0, 1}, 0.7, 1, ""});
    compile::CompiledScene compiled = compile::compile(s);
    const std::vector<float> expected = test::plane_values(render(compiled, {}).picture);
    for (const accel::Traversal traversal : {accel::Traversal::kPacket, accel::Traversal::kSingle}) {
      Settings settings;
      settings.threads = 3;
      settings.traversal = traversal;
      EXPECT_EQ(test::plane_values(render(compiled, settings).picture), expected);
    }
    compiled.accelerator = compile::Accelerator::kList;
    EXPECT_EQ(test::plane_values(render(compiled, {}).picture), expected);
  }
}

}  // namespace
}  // namespace orrery::render
