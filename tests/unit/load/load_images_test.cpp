// SPDX-License-Identifier: Apache-2.0
#include "load/load_images.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <memory>
#include <string>
#include <utility>

#include "base/error.h"
#include "film/picture.h"
#include "image/write.h"
#include "scene/scene.h"
#include "scene/texture.h"
#include "sky/daylight.h"
#include "support/exr_file.h"
#include "support/mentions.h"
#include "support/temp_dir.h"

namespace orrery::load {
namespace {

using support::ExrFile;

class LoadBackground : public testing::Test {
 protected:
  void SetUp() override {
    ::unsetenv("OCIO");
    scene_.background.type = scene::BackgroundType::kImage;
    scene_.background.file = "a.exr";
    request_.folder = (folder_ / "a.exr").parent_path();
  }
  LoadedMap load(const ExrFile& exr) {
    support::write_bytes(folder_ / "a.exr", exr.bytes());
    return load_background(request_, scene_);
  }
  /// "key: text" of each diagnostic.
  static std::vector<std::string> texts(const LoadedMap& loaded) {
    std::vector<std::string> out;
    for (const scene::SceneDiagnostic& d : loaded.diagnostics) out.push_back(d.key + ": " + d.text);
    return out;
  }
  using Texts = std::vector<std::string>;
  /// Whether there is one diagnostic, with these facts.
  static testing::AssertionResult has_one(const LoadedMap& loaded, const std::vector<std::string_view>& facts) {
    const Texts all = texts(loaded);
    if (all.size() != 1) return testing::AssertionFailure() << all.size() << " diagnostics";
    return test::mentions(all[0], facts);
  }

  support::TempDir folder_;
  scene::Scene scene_;
  ImageRequest request_;
};

TEST_F(LoadBackground, TexelsAreThoseOfTheFile) {
  const LoadedMap loaded = load({2, 1, {1, 2, 3, 4, 5, 6}});
  EXPECT_EQ(texts(loaded), Texts{});
  ASSERT_NE(loaded.image, nullptr);
  EXPECT_EQ(std::vector<float>(loaded.image->row(0), loaded.image->row(0) + 6), (std::vector<float>{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(loaded.color_space, "lin_rec709");
  EXPECT_EQ(loaded.bytes, 2u * 12 + 2 * 4 / 3);
}

/// Red in ACEScg is (1.7051, -0.1302, -0.0240) in Rec.709.
TEST_F(LoadBackground, TheDeclaredColourSpaceComesBeforeTheScenes) {
  ExrFile exr = ExrFile::constant(2, 1, {1, 0.5F, 0.5F});
  const auto red = [](const LoadedMap& loaded) { return loaded.image->row(0)[0]; };
  EXPECT_EQ(red(load(exr)), 1);
  scene_.color.space = "ACEScg";
  scene_.color.working = "lin_rec709";
  const float converted = red(load(exr));
  EXPECT_NEAR(converted, 0.5 * 1.7051 + 0.5, 1e-3) << "color.space";
  scene_.background.color_space = "lin_rec709";
  EXPECT_EQ(red(load(exr)), 1) << "background.color_space";
  exr.chromaticities = {0.713F, 0.293F, 0.165F, 0.83F, 0.128F, 0.044F, 0.3217F, 0.3377F};
  scene_.background.color_space = "acescg";
  EXPECT_EQ(texts(load(exr)), Texts{}) << "the same space by another name";
  scene_.background.color_space = "lin_rec709";
  EXPECT_NEAR(red(load(exr)), converted, 1e-6);
  EXPECT_EQ(texts(load(exr)),
            Texts{"background.color_space: is ignored: a.exr declares the colour space `lin_ap1_scene`"});
  exr.color_interop_id = "lin_rec709_scene";
  EXPECT_EQ(red(load(exr)), 1) << "colorInteropID comes before chromaticities";
}

TEST_F(LoadBackground, AnUnknownDeclaredSpaceIsAWarningAndAnUnknownKeyAnError) {
  ExrFile exr = ExrFile::constant(2, 1, {1, 1, 1});
  exr.color_interop_id = "foo_scene";
  LoadedMap loaded = load(exr);
  ASSERT_EQ(loaded.diagnostics.size(), 1u);
  EXPECT_EQ(loaded.diagnostics[0].severity, base::Severity::kWarning);
  EXPECT_NE(loaded.image, nullptr);
  exr.color_interop_id.clear();
  exr.chromaticities = {0.1F, 0.2F, 0.3F, 0.4F, 0.5F, 0.6F, 0.7F, 0.8F};
  loaded = load(exr);
  EXPECT_TRUE(has_one(loaded, {"background.file", "chromaticities", "ignored"}));
  exr.chromaticities.clear();
  scene_.background.color_space = "foo";
  loaded = load(exr);
  ASSERT_EQ(loaded.diagnostics.size(), 1u);
  EXPECT_EQ(loaded.diagnostics[0].severity, base::Severity::kError);
  EXPECT_EQ(loaded.diagnostics[0].key, "background.color_space");
  EXPECT_EQ(loaded.image, nullptr);
}

TEST_F(LoadBackground, DisplaySpacesAreLinearized) {
  scene_.background.color_space = "srgb_texture";
  const LoadedMap loaded = load(ExrFile::constant(2, 1, {0.5F, 0.5F, 0.5F}));
  EXPECT_EQ(texts(loaded), Texts{});
  EXPECT_NEAR(loaded.image->row(0)[1], 0.21404, 1e-4);
}

TEST_F(LoadBackground, InvalidRadianceCountsAsZero) {
  ExrFile exr = ExrFile::constant(4, 2, {1, 1, 1});
  exr.rgb[0] = std::numeric_limits<float>::quiet_NaN();
  exr.rgb[5] = -std::numeric_limits<float>::infinity();
  exr.rgb[8] = -1e-6F;
  exr.rgb[9] = -0.0F;
  const LoadedMap loaded = load(exr);
  EXPECT_EQ(texts(loaded), Texts{"background.file: 1 values are NaN and 2 negative; they are replaced by 0"});
  for (int i = 0; i < 24; ++i) EXPECT_EQ(loaded.image->row(0)[i], i == 0 || i == 5 || i == 8 || i == 9 ? 0 : 1) << i;
}

/// An infinite texel is a sun that did not fit into the file: it must not be black.
TEST_F(LoadBackground, InfiniteRadianceIsTheLargestThatTheFileCanHold) {
  for (const bool is_half : {false, true}) {
    ExrFile exr = ExrFile::constant(4, 2, {1, 1, 1});
    exr.rgb[4] = std::numeric_limits<float>::infinity();
    exr.is_half = is_half;
    const LoadedMap loaded = load(exr);
    const std::string value = is_half ? "65504; write brighter values in single precision" : "17179869184";
    EXPECT_TRUE(has_one(loaded, {"background.file", "1", "infinite", value}));
    for (int i = 0; i < 24; ++i) EXPECT_EQ(loaded.image->row(0)[i], i != 4 ? 1 : is_half ? 65504 : 0x1p34F) << i;
  }
}

TEST_F(LoadBackground, ValuesBeyondTheFilmAreClamped) {
  ExrFile exr = ExrFile::constant(4, 2, {1, 1, 1});
  exr.rgb[4] = 1e30F;
  const LoadedMap loaded = load(exr);
  EXPECT_TRUE(has_one(loaded, {"background.file", "1 values", "lin_rec709", "clamped"}));
  EXPECT_EQ(loaded.image->row(0)[4], 0x1p34F);
  EXPECT_EQ(loaded.brightest, 0x1p34F);
}

TEST_F(LoadBackground, ColoursOutsideTheWorkingSpaceAreClamped) {
  ExrFile exr = ExrFile::constant(2, 1, {0, 1, 0});
  exr.color_interop_id = "lin_ap1_scene";
  const LoadedMap loaded = load(exr);
  EXPECT_TRUE(has_one(loaded, {"background.file", "4 values", "lin_rec709", "clamped"}));
  EXPECT_EQ(loaded.image->row(0)[0], 0);
}

TEST_F(LoadBackground, OtherProportionsAreAWarning) {
  EXPECT_TRUE(has_one(load(ExrFile::constant(3, 2, {1, 1, 1})), {"background.file", "3 x 2", "twice as wide"}));
}

TEST_F(LoadBackground, TexelsOutsideTheDataWindowAreAWarning) {
  ExrFile exr = ExrFile::constant(2, 2, {1, 1, 1});
  exr.display_width = 4;
  const LoadedMap loaded = load(exr);
  EXPECT_TRUE(has_one(loaded, {"background.file", "data window", "display window", "black"}));
  EXPECT_EQ(std::vector<float>(loaded.image->row(1), loaded.image->row(1) + 12),
            (std::vector<float>{1, 1, 1, 1, 1, 1, 0, 0, 0, 0, 0, 0}));
}

TEST_F(LoadBackground, MemoryIsCheckedBeforePixelsAreRead) {
  support::write_bytes(folder_ / "a.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 32768 +X 65536\n");
  scene_.background.file = "a.hdr";
  request_.memory_limit = 1 << 30;
  try {
    load_background(request_, scene_);
    FAIL() << "a file without pixels";
  } catch (const base::Error& error) {
    EXPECT_EQ(error.kind(), base::ErrorKind::kNoMemory);
    EXPECT_NE(std::string(error.what()).find("needs about 26.7 GiB, and --memory-limit allows 1.0 GiB"),
              std::string::npos)
        << error.what();
  }
  scene_.render.direct_lighting = scene::DirectLighting::kBsdf;
  request_.skips_large = true;
  const LoadedMap loaded = load_background(request_, scene_);
  EXPECT_EQ(loaded.bytes, std::uint64_t{12} << 31) << "without tables";
  EXPECT_EQ(loaded.image, nullptr);
  ASSERT_EQ(loaded.diagnostics.size(), 1u);
  EXPECT_EQ(loaded.diagnostics[0].severity, base::Severity::kWarning);
}

TEST_F(LoadBackground, TheVersionIdentifiesFileAndConversion) {
  const LoadedMap first = load(ExrFile::constant(3, 2, {1, 1, 1}));
  EXPECT_EQ(first.version, background_version(request_, scene_));
  scene_.background.color_space = "acescg";
  EXPECT_NE(first.version, background_version(request_, scene_)) << "another conversion";
  scene_.background.color_space = "";
  EXPECT_EQ(first.version, background_version(request_, scene_));
  EXPECT_NE(first.version, load(ExrFile::constant(5, 2, {2, 2, 2})).version) << "the file has changed";
}

scene::Scene evening() {
  scene::Scene scene;
  scene.background.type = scene::BackgroundType::kSky;
  scene.background.sun_elevation = 10;
  return scene;
}

TEST(LoadSky, InRec709ItIsTheModel) {
  const LoadedMap loaded = load_sky("", evening());
  ASSERT_NE(loaded.image, nullptr);
  EXPECT_TRUE(loaded.diagnostics.empty());
  EXPECT_EQ(loaded.width, 512);
  EXPECT_EQ(loaded.height, 256);
  EXPECT_EQ(loaded.color_space, "lin_rec709");
  const scene::LatLongMap model = sky::bake_sky(evening().background);
  for (const int y : {0, 100, 255})
    EXPECT_TRUE(std::equal(model.row(y), model.row(y) + 3 * 512, loaded.image->row(y))) << y;
  EXPECT_EQ(loaded.image->sun.radiance, model.sun.radiance);
}

/// White is the same in both spaces, so the grey ground stays grey, and the luminance stays the same: about
/// 0.2722 R + 0.6741 G + 0.0537 B in ACEScg.
TEST(LoadSky, IsConvertedToTheWorkingSpace) {
  ::unsetenv("OCIO");
  scene::Scene scene = evening();
  const LoadedMap rec709 = load_sky("", scene);
  scene.color.working = "acescg";
  const LoadedMap acescg = load_sky("", scene);
  ASSERT_NE(acescg.image, nullptr);
  const auto luminance = [](const double r, const double g, const double b) {
    return std::pair{0.2126 * r + 0.7152 * g + 0.0722 * b, 0.2722 * r + 0.6741 * g + 0.0537 * b};
  };
  for (const int y : {0, 60, 120, 200}) {
    const float *const a = rec709.image->row(y), *const b = acescg.image->row(y);
    EXPECT_NE(a[0], b[0]);
    EXPECT_NEAR(luminance(b[0], b[1], b[2]).second / luminance(a[0], a[1], a[2]).first, 1, 0.01) << y;
  }
  const math::Vec3d a = rec709.image->sun.radiance, b = acescg.image->sun.radiance;
  EXPECT_NEAR(luminance(b.x, b.y, b.z).second / luminance(a.x, a.y, a.z).first, 1, 0.01);
}

TEST(LoadSky, TheAlbedoIsInTheSpaceOfTheScene) {
  ::unsetenv("OCIO");
  scene::Scene scene = evening();
  scene.background.ground_albedo = {0.1, 0.4, 0.1};
  const LoadedMap rec709 = load_sky("", scene);
  scene.color.space = scene.color.working = "acescg";
  scene.background.ground_albedo = {0.1, 0.4, 0.1};
  const LoadedMap acescg = load_sky("", scene);
  const float *const a = rec709.image->row(200), *const b = acescg.image->row(200);
  EXPECT_NEAR(b[1] / b[0] / (a[1] / a[0]), 1, 0.3) << "green ground is about as green";
  EXPECT_NE(a[0], b[0]);
}

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
  EXPECT_TRUE(test::mentions(text(loaded[0]), {"material.m0.albedo.file", "2", "lin_rec709"}));
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
  EXPECT_NE(text(load()[0]).find("exr, hdr, png, tiff, jpeg or ppm"), std::string::npos);
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
