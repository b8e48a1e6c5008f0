// SPDX-License-Identifier: Apache-2.0
#include "load/load_images.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <utility>

#include "base/error.h"
#include "film/picture.h"
#include "image/write.h"
#include "scene/scene.h"
#include "scene/texture.h"
#include "support/exr_file.h"
#include "support/temp_dir.h"

namespace orrery::load {
namespace {

using support::ExrFile;

class LoadTextures : public testing::Test {
 protected:
  void SetUp() override { ::unsetenv("OCIO"); }

  /// Adds a material whose albedo is this file.
  void add(const std::string& name, const std::string& color_space = {}) {
    scene_.materials.push_back(
        {"m" + std::to_string(scene_.materials.size()), scene::Lambertian{{1, 1, 1}, map(name, color_space)}});
  }
  static scene::TextureSlot map(const std::string& name, const std::string& color_space = {},
                                scene::TextureFilter filter = scene::TextureFilter::kMip) {
    scene::Texture texture;
    texture.filter = filter;
    texture.type = scene::TextureType::kImage;
    texture.file = name;
    texture.color_space = color_space;
    return std::make_shared<const scene::Texture>(texture);
  }
  /// Writes an image of one colour with encoded values.
  void write_flat(const std::string& name, float value) {
    film::EncodedPicture picture;
    picture.width = 64;
    picture.height = 32;
    picture.values.assign(3 * 64 * 32, static_cast<std::uint16_t>(std::lround(value * 255)));
    for (std::size_t i = 0; i < picture.values.size(); i += 7) ++picture.values[i];  // does not compress to nothing
    image::write_encoded(folder_ / name, picture, "test");
  }
  void truncate(const std::string& name, std::uintmax_t bytes) { std::filesystem::resize_file(folder_ / name, bytes); }
  std::vector<LoadedTexture> load(const std::vector<LoadedTexture>& known = {}, std::uint64_t limit = 0) {
    return load_textures({(folder_ / "a").parent_path(), "", limit}, known, scene_);
  }
  static std::string text(const LoadedTexture& texture) {
    std::string out;
    for (const scene::SceneDiagnostic& d : texture.map.diagnostics) out += d.key + ": " + d.text + "\n";
    return out;
  }

  support::TempDir folder_;
  scene::Scene scene_;
};

TEST_F(LoadTextures, EncodedFilesAreSrgbUnlessTheSceneSaysOtherwise) {
  write_flat("a.png", 0.5F);
  add("a.png");
  add("a.png", "raw");
  const auto loaded = load();
  ASSERT_EQ(loaded.size(), 2u);
  EXPECT_EQ(text(loaded[0]), "");
  ASSERT_NE(loaded[0].map.image, nullptr);
  EXPECT_NEAR(loaded[0].map.image->row(3)[4], 0.2140, 0.003) << "sRGB 0.5";
  EXPECT_EQ(loaded[0].map.color_space, "srgb_texture");
}

/// Alpha is ignored: the colours are those of the file.
TEST_F(LoadTextures, ColorsAreNotMultipliedByAlpha) {
  film::EncodedPicture picture;
  picture.width = 64;
  picture.height = 32;
  picture.channels = 4;
  for (int i = 0; i < 64 * 32; ++i)
    for (const int v : {200, 100, 50, i % 2 == 0 ? 128 : 0}) picture.values.push_back(static_cast<std::uint16_t>(v));
  for (const char* name : {"a.png", "a.tif"}) {
    image::write_encoded(folder_ / name, picture, "test");
    scene_.materials.clear();
    add(name, "raw");
    const auto loaded = load();
    ASSERT_NE(loaded.at(0).map.image, nullptr) << name;
    for (const std::size_t x : {0, 1}) {
      EXPECT_NEAR(loaded[0].map.image->row(3)[3 * x], 200 / 255.0, 0.002) << name << x;
      EXPECT_NEAR(loaded[0].map.image->row(3)[3 * x + 2], 50 / 255.0, 0.002) << name << x;
    }
  }
}

TEST_F(LoadTextures, NumbersAreNotConverted) {
  write_flat("a.png", 0.5F);
  scene_.materials.push_back({"m", scene::Metal{{1, 1, 1}, 0, nullptr, map("a.png")}});
  const auto loaded = load();
  ASSERT_EQ(loaded.size(), 1u);
  ASSERT_NE(loaded[0].map.image, nullptr);
  EXPECT_NEAR(loaded[0].map.image->row(3)[4], 0.5, 0.003);
}

TEST_F(LoadTextures, ReflectancesAboveOneAreClampedAndReported) {
  support::write_bytes(folder_ / "a.exr", ExrFile{2, 1, {0.5F, 2, 0.5F, 1, 1, 3}}.bytes());
  add("a.exr");
  const auto loaded = load();
  EXPECT_EQ(text(loaded[0]), "material.m0.albedo.file: 2 values are out of range in lin_rec709 and were clamped\n");
  EXPECT_EQ(loaded[0].map.image->row(0)[1], 1);
  scene::Emitter lamp;
  lamp.radiance_texture = map("a.exr");
  scene_.materials = {{"lamp", lamp}};
  EXPECT_EQ(load()[0].map.image->row(0)[5], 3) << "radiance may exceed 1";
}

TEST_F(LoadTextures, AFileThatIsMissingIsAnError) {
  add("none.png");
  const auto loaded = load();
  ASSERT_EQ(loaded[0].map.diagnostics.size(), 1u);
  EXPECT_EQ(loaded[0].map.diagnostics[0].kind, base::ErrorKind::kMissingInput);
  EXPECT_NE(text(loaded[0]).find("material.m0.albedo.file: "), std::string::npos);
  EXPECT_NE(text(loaded[0]).find("No such file"), std::string::npos);
}

TEST_F(LoadTextures, ATruncatedFileIsAnErrorInEveryFormat) {
  for (const std::string name : {"a.png", "a.jpg", "a.tif", "a.ppm"}) {
    write_flat(name, 0.7F);
    const auto size = std::filesystem::file_size(folder_ / name);
    scene_.materials.clear();
    add(name);
    EXPECT_EQ(text(load()[0]), "") << name;
    truncate(name, size - size / 4);
    const auto loaded = load();
    EXPECT_EQ(loaded[0].map.image, nullptr) << name;
    EXPECT_NE(text(loaded[0]).find(name), std::string::npos) << name << ": " << text(loaded[0]);
  }
}

TEST_F(LoadTextures, AnUnknownFormatIsAnError) {
  support::write_bytes(folder_ / "a.webp", "RIFF");
  add("a.webp");
  EXPECT_NE(text(load()[0]).find("a texture must be an exr, hdr, png, tiff, jpeg or ppm file"), std::string::npos);
}

TEST_F(LoadTextures, AFileIsReadOnceForAllItsUses) {
  write_flat("a.png", 0.5F);
  add("a.png");
  add("a.png");
  const auto loaded = load();
  EXPECT_EQ(loaded[0].map.image, loaded[1].map.image);
  EXPECT_TRUE(loaded[1].is_shared);
  EXPECT_EQ(load(loaded)[0].map.image, loaded[0].map.image) << "by the next load, too";
}

TEST_F(LoadTextures, OnlyFilteredImagesHaveAMipMap) {
  write_flat("a.png", 0.5F);
  add("a.png");
  scene_.materials.push_back(
      {"sharp", scene::Lambertian{{1, 1, 1}, map("a.png", {}, scene::TextureFilter::kBilinear)}});
  const auto loaded = load();
  EXPECT_EQ(loaded[0].map.image->reduced.size(), 1u);
  EXPECT_EQ(loaded[0].map.bytes, (64 * 32 + 32 * 16) * 12u);
  EXPECT_FALSE(loaded[1].is_shared);
  EXPECT_TRUE(loaded[1].map.image->reduced.empty());
  EXPECT_EQ(loaded[1].map.bytes, 64 * 32 * 12u);
}

TEST_F(LoadTextures, TheMemoryLimitHoldsForAllOfThem) {
  write_flat("a.png", 0.5F);
  write_flat("b.png", 0.5F);
  add("a.png");
  constexpr std::uint64_t kBytes = (64 * 32 + 32 * 16) * 12;  // with a mip map
  EXPECT_THROW(load({}, kBytes - 1), base::Error);
  EXPECT_NO_THROW(load({}, kBytes));
  add("b.png");
  EXPECT_THROW(load({}, kBytes * 3 / 2), base::Error);
}

TEST_F(LoadTextures, TheSceneGetsTheImages) {
  write_flat("a.png", 0.5F);
  add("a.png");
  const auto loaded = load();
  set_textures(loaded, scene_);
  EXPECT_EQ(std::get<scene::Lambertian>(scene_.materials[0].model).albedo_texture->image, loaded[0].map.image);
}

}  // namespace
}  // namespace orrery::load
