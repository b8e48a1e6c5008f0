// SPDX-License-Identifier: Apache-2.0
// Checks in small images of the scenes what The Next Week describes, and that textures of one colour are constants.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "film/picture.h"
#include "image/render_scene.h"
#include "load/load_scene.h"
#include "load/read_scene.h"
#include "render/render.h"
#include "render/result.h"
#include "render/settings.h"
#include "scene/lat_long_map.h"
#include "scene/scene.h"
#include "scene/schema.h"
#include "scene/texture.h"
#include "support/read_scene_file.h"

namespace orrery {
namespace {

constexpr int kSceneWidth = 96, kSceneHeight = 54;

film::Picture picture_of_scene(const std::string& name, load::Overrides overrides = {}) {
  overrides.add("image.width=" + std::to_string(kSceneWidth));
  overrides.add("image.height=" + std::to_string(kSceneHeight));
  load::SceneRequest request;
  request.source.file = std::filesystem::path(ORRERY_SCENES) / "next-week" / (name + ".toml");
  request.source.overrides = overrides;
  return test::render_scene(load::load_scene(request).read);
}

using Rgb = std::tuple<float, float, float>;
Rgb pixel(const film::Picture& p, double u, double v) {
  const auto at =
      static_cast<std::size_t>(static_cast<int>(v * kSceneHeight) * kSceneWidth + static_cast<int>(u * kSceneWidth));
  return {p.planes[0].values[at], p.planes[1].values[at], p.planes[2].values[at]};
}
double brightness(const Rgb& c) { return static_cast<double>(std::get<0>(c) + std::get<1>(c) + std::get<2>(c)) / 3; }

/// Mean and standard deviation of the brightness in a rectangle.
struct Spread {
  double mean = 0, deviation = 0;
};
Spread spread(const film::Picture& p, double left, double top, double right, double bottom) {
  double sum = 0, squares = 0;
  int count = 0;
  for (double v = top; v < bottom; v += 1.0 / kSceneHeight)
    for (double u = left; u < right; u += 1.0 / kSceneWidth, ++count) {
      const double b = brightness(pixel(p, u, v));
      sum += b;
      squares += b * b;
    }
  const double mean = sum / count;
  return {mean, std::sqrt(std::max(squares / count - mean * mean, 0.0))};
}

const load::Overrides kFlat = {"render.shading=flat", "render.samples=1"};

TEST(ImageNextWeekPictures, ACheckerHasTwoColours) {
  const film::Picture p = picture_of_scene("02-checkered-spheres", kFlat);
  std::set<Rgb> colors;
  for (std::size_t i = 0; i < p.planes[0].values.size(); ++i)
    colors.insert({p.planes[0].values[i], p.planes[1].values[i], p.planes[2].values[i]});
  EXPECT_EQ(colors.size(), 3u) << "two of the checker and the background";
  EXPECT_TRUE(colors.count({0.2F, 0.3F, 0.1F}) == 1 && colors.count({0.9F, 0.9F, 0.9F}) == 1);
}

TEST(ImageNextWeekPictures, ThePlanetHasIceAtTheTopAndSeaBelow) {
  const film::Picture p = picture_of_scene("03-planet", {"render.shading=flat", "render.samples=16"});
  EXPECT_GT(brightness(pixel(p, 0.5, 0.03)), 0.6);
  int sea = 0, land = 0;
  for (int y = kSceneHeight / 3; y < kSceneHeight * 2 / 3; ++y)
    for (int x = kSceneWidth * 2 / 5; x < kSceneWidth * 3 / 5; ++x) {
      const auto [r, g, b] = pixel(p, (x + 0.5) / kSceneWidth, (y + 0.5) / kSceneHeight);
      sea += b > 2 * r ? 1 : 0;
      land += r > 1.2F * b ? 1 : 0;
    }
  EXPECT_GT(sea, 50);
  EXPECT_GT(land, 20);
}

TEST(ImageNextWeekPictures, NoiseIsGreyTurbulenceIsDarkerAndMarbleReachesBothEnds) {
  const auto ball = [](const std::string& name) {
    return spread(picture_of_scene(name, {"render.shading=flat", "render.samples=16"}), 0.4, 0.05, 0.6, 0.4);
  };
  const Spread noise = ball("04-perlin-noise"), turbulence = ball("05-turbulence"), marble = ball("06-marble");
  EXPECT_NEAR(noise.mean, 0.5, 0.1);
  EXPECT_GT(noise.deviation, 0.03);
  EXPECT_LT(turbulence.mean, 0.45);
  EXPECT_GT(marble.deviation, 1.5 * noise.deviation);
}

TEST(ImageNextWeekPictures, TheLampLightsTheFloorNextToIt) {
  const film::Picture p = picture_of_scene("07-lamp");
  EXPECT_EQ(brightness(pixel(p, 0.05, 0.05)), 0);
  EXPECT_GT(spread(p, 0.77, 0.75, 0.87, 0.79).mean, 4 * spread(p, 0.02, 0.75, 0.15, 0.79).mean);
}

TEST(ImageNextWeekPictures, SmallSpheresMoveAndTheGroundDoesNot) {
  const film::Picture moving = picture_of_scene("01-bouncing-spheres", {"render.samples=32"});
  const film::Picture still = picture_of_scene("01-bouncing-spheres", {"render.samples=32", "camera.shutter_close=0"});
  double changed = 0;
  for (int y = kSceneHeight / 2; y < kSceneHeight; ++y)
    for (int x = 0; x < kSceneWidth; ++x) {
      const double u = (x + 0.5) / kSceneWidth, v = (y + 0.5) / kSceneHeight;
      changed += std::abs(brightness(pixel(moving, u, v)) - brightness(pixel(still, u, v))) > 0.1 ? 1 : 0;
    }
  EXPECT_GT(changed / (kSceneWidth * kSceneHeight / 2), 0.05);
  EXPECT_LT(changed / (kSceneWidth * kSceneHeight / 2), 0.5);
}

TEST(ImageNextWeekPictures, RoughGlassBlursWhatIsBehindIt) {
  const film::Picture p = picture_of_scene("08-rough-glass", {"render.samples=256"});
  EXPECT_LT(spread(p, 0.335, 0.36, 0.425, 0.46).deviation, 0.6 * spread(p, 0.09, 0.36, 0.18, 0.46).deviation);
}

/// Renders the scene with every texture flattened to one colour, either as a texture or as a constant. Caustics are
/// sampled only of balls and lamps without textures.
film::Picture flattened(bool as_texture, const std::string& precision) {
  auto read =
      support::read_scene_file(std::filesystem::path(ORRERY_SCENES) / ".." / "tests" / "determinism" / "textures.toml",
                               {"render.precision=" + precision, "render.caustics=false", "material.rough.fuzz=0"});
  for (scene::Material& material : read.scene.materials) {
    for (const scene::TexturedKey& key : scene::material_types()[material.model.index()].textured) {
      const scene::TextureSlot texture = key.get(material.model);
      if (!texture) continue;
      scene::Texture flat = *texture;
      flat.low = flat.high;
      key.at(material.model) = as_texture ? std::make_shared<const scene::Texture>(flat) : nullptr;
      for (const auto& constant : scene::material_types()[material.model.index()].keys)
        if (constant.name == key.name)
          constant.set(material.model,
                       key.use == scene::TextureUse::kNumber ? scene::Value(flat.high.x) : scene::Value(flat.high));
    }
  }
  const auto compiled = compile::compile(read.scene, &*read.closing);
  EXPECT_EQ(compiled.features.rich_materials, as_texture);
  return render::render(compiled, {}).picture;
}

TEST(ImageNextWeekPictures, ATextureOfOneColourIsAConstantBitForBit) {
  for (const std::string precision : {"exact", "fast", "book"}) {
    const film::Picture textured = flattened(true, precision), constant = flattened(false, precision);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(textured.planes[c].values, constant.planes[c].values) << precision;
  }
}

TEST(ImageNextWeekPictures, LightAndBsdfSamplingOfATexturedEmitterAgree) {
  const auto mean = [](const std::string& mode) {
    const auto read = support::read_scene_file(
        std::filesystem::path(ORRERY_SCENES) / ".." / "tests" / "determinism" / "textures.toml",
        {"render.direct_lighting=" + mode, "render.samples=6000", "background.type=constant",
         "background.color=[0,0,0]", "image.width=40", "image.height=24", "image.crop=[0,18,40,6]",
         // The lower half shines: the lamp's centre is on a face of the cells.
         "material.lamp.radiance={texture=\"checker\",scale=1.6,even=[0,0,0],odd=[9,9,9]}"});
    const film::Picture p = render::render(compile::compile(read.scene, &*read.closing), {}).picture;
    // The floor; caustics of the metal and the glass would be noise.
    double sum = 0;
    for (const float green : p.planes[1].values) sum += static_cast<double>(green);
    return sum;
  };
  const double mis = mean("mis"), bsdf = mean("bsdf");
  EXPECT_GT(mis, 1);
  EXPECT_NEAR(mis / bsdf, 1, 0.06);
}

}  // namespace
}  // namespace orrery
