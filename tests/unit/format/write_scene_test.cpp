// SPDX-License-Identifier: Apache-2.0
#include "format/write_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>

#include "scene/schema.h"
#include "scene/textures.h"
#include "support/scene_files.h"

namespace orrery::format {
namespace {

using support::SceneFiles;

scene::TextureSlot texture(scene::TextureType type) {
  scene::Texture out;
  out.type = type;
  out.scale = 1.0 / 3;
  out.seed = 4000000000u;
  out.low = {0.1, 0.1, 0.1};
  out.high = {2.0 / 3, 2.0 / 3, 2.0 / 3};
  out.file = "a \"b\".png";
  out.rotation = -90;
  return std::make_shared<const scene::Texture>(out);
}

/// A scene without default values, with numbers of many decimals.
scene::Scene odd_scene() {
  scene::Scene s;
  s.image = {17, 19};
  s.camera = {{0.1, -0.0, 1e17}, {1.0 / 3, 2, 3}, {0, 0.2, 1}, 33.3, 0.7, 1e-20};
  s.background = {scene::BackgroundType::kConstant, {0.1, 0.2, 0.3}, {4, 5, 6}, {7, 8, 9}};
  s.render = {3, 4, 4000000000u, scene::Precision::kBook, scene::Shading::kFlat, scene::Accelerator::kList};
  s.color.space = "a \"b\" \\ \xC3\xBC\n";
  s.materials = {
      {"z", scene::Lambertian{{0.1, 0.2, 1.0 / 3}}},
      {"dark gold", scene::Metal{{0.4, 0.5, 0.6}, 1.0 / 7}},
      {"", scene::Dielectric{1e-6, scene::Fresnel::kExact}},
      {"a.b", scene::Hemisphere{{0, 0.5, 1}}},
      {"checkered", scene::Lambertian{{0.5, 0.5, 0.5}, texture(scene::TextureType::kChecker)}},
      {"map",
       scene::Metal{{0.5, 0.5, 0.5}, 0, texture(scene::TextureType::kImage), texture(scene::TextureType::kMarble)}}};
  s.spheres = {{{1, -2.5, 1e-300}, -1.0 / 3, 1, "left \"one\""}, {{1e18, 0, -0.0}, 1e-30, 3, ""}};
  return s;
}

TEST(FormatWriteScene, ReadsBackToTheSameScene) {
  SceneFiles files;
  const scene::Scene s = odd_scene();
  const scene::Scene read = files.read(scene_text(s, "a comment")).scene;
  for (const scene::Table& table : scene::tables())
    for (const auto& key : table.keys) EXPECT_EQ(key.text(read), key.text(s)) << key.name;
  ASSERT_EQ(read.materials.size(), s.materials.size());
  for (std::size_t i = 0; i < s.materials.size(); ++i) {
    EXPECT_EQ(read.materials[i].name, s.materials[i].name);
    ASSERT_EQ(read.materials[i].model.index(), s.materials[i].model.index());
    for (const auto& key : scene::material_types()[s.materials[i].model.index()].keys)
      EXPECT_EQ(key.text(read.materials[i].model), key.text(s.materials[i].model)) << key.name;
  }
  const auto written = scene::textures(s), again = scene::textures(read);
  ASSERT_EQ(again.size(), written.size());
  for (std::size_t i = 0; i < written.size(); ++i) {
    EXPECT_EQ(again[i].key, written[i].key);
    ASSERT_EQ(again[i].texture->type, written[i].texture->type);
    const auto& types = scene::texture_types(written[i].use);
    for (const auto& key : types[static_cast<std::size_t>(written[i].texture->type)].keys)
      EXPECT_EQ(key.text(*again[i].texture), key.text(*written[i].texture)) << key.name;
  }
  ASSERT_EQ(read.spheres.size(), s.spheres.size());
  for (std::size_t i = 0; i < s.spheres.size(); ++i) {
    EXPECT_EQ(read.spheres[i].center, s.spheres[i].center);
    EXPECT_EQ(read.spheres[i].radius, s.spheres[i].radius);
    EXPECT_EQ(read.spheres[i].material, s.spheres[i].material);
    EXPECT_EQ(read.spheres[i].name, s.spheres[i].name);
  }
  EXPECT_TRUE(std::signbit(read.camera.look_from.y) && std::signbit(read.spheres[1].center.z)) << "-0 is not 0";
}

TEST(FormatWriteScene, RandomNumbersReadBackToTheSameBits) {
  SceneFiles files;
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> mantissa(1, 2);
  std::uniform_int_distribution<int> exponent(-90, 58);
  scene::Scene s;
  s.materials = {{"a", scene::Dielectric{}}};
  const auto number = [&] { return std::ldexp(mantissa(random), exponent(random)); };
  for (int i = 0; i < 2000; ++i) s.spheres.push_back({{number(), -number(), number()}, number(), 0, ""});
  const scene::Scene read = files.read(scene_text(s, "")).scene;
  ASSERT_EQ(read.spheres.size(), s.spheres.size());
  for (std::size_t i = 0; i < s.spheres.size(); ++i) {
    EXPECT_EQ(read.spheres[i].center, s.spheres[i].center);
    EXPECT_EQ(read.spheres[i].radius, s.spheres[i].radius);
  }
}

TEST(FormatWriteScene, DefaultsAreNotWritten) {
  EXPECT_EQ(scene_text({}, ""), "");
  scene::Scene s;
  s.render.samples = 7;
  s.materials = {{"glass", scene::Dielectric{}}};
  EXPECT_EQ(scene_text(s, "two\n\nlines"),
            "# two\n#\n# lines\n\n[render]\nsamples = 7\n\n[material]\nglass = { type = \"dielectric\" }\n");
}

TEST(FormatWriteScene, CommentsAcceptAnyFileName) {
  SceneFiles files;
  scene::Scene s;
  s.camera.vfov = 33;
  const std::string text = scene_text(s, "made of a\rb\x1b[31m.toml \x7f");
  EXPECT_EQ(text.find_first_of("\r\x1b\x7f"), std::string::npos) << "control characters are not valid in a comment";
  EXPECT_EQ(files.read(text).scene.camera.vfov, 33);
}

TEST(FormatWriteScene, AnUnwritableSceneIsAnInternalError) {
  const auto kind_of = [](const scene::Scene& s) {
    try {
      scene_text(s, "");
    } catch (const base::Error& error) {
      return error.kind();
    }
    return base::ErrorKind::kIo;
  };
  scene::Scene s;
  s.spheres.resize(1);
  EXPECT_EQ(kind_of(s), base::ErrorKind::kInternal);
  s = {};
  s.materials = {{"a", scene::Dielectric{}}, {"a", scene::Dielectric{}}};
  EXPECT_EQ(kind_of(s), base::ErrorKind::kInternal);
}

TEST(FormatWriteScene, MissingFolderIsCannotCreate) {
  const support::TempDir folder;
  try {
    write_scene({}, "", folder / "none" / "s.toml");
    FAIL() << "no error";
  } catch (const base::Error& error) {
    EXPECT_EQ(error.kind(), base::ErrorKind::kCannotCreate);
  }
}

}  // namespace
}  // namespace orrery::format
