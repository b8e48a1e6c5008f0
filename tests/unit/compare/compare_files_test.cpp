// SPDX-License-Identifier: Apache-2.0
#include "compare/compare_files.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "image/format.h"
#include "image/header.h"
#include "image/read.h"
#include "image/write.h"
#include "support/temp_dir.h"

namespace orrery::compare {
namespace {

film::Picture grey(int width, int height, float value) {
  const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  film::Picture picture{width, height, {}};
  for (const char* name : {"R", "G", "B"}) picture.planes.push_back({name, std::vector<float>(pixels, value)});
  return picture;
}

Comparison of_light(const film::Picture& a, const film::Picture& b) { return compare(a, b, Encoding::kLight); }

TEST(CompareFiles, EqualImagesHaveNoError) {
  const Comparison c = of_light(grey(4, 3, 0.5f), grey(4, 3, 0.5f));
  EXPECT_EQ(c.errors.rmse, 0);
  EXPECT_EQ(c.errors.max_channel, -1);
  EXPECT_EQ(c.ssim, 1.0);
  EXPECT_EQ(c.flip, 0.0);
  EXPECT_EQ(c.differing, 0u);
  EXPECT_FALSE(c.z_test);
  EXPECT_TRUE(std::isinf(c.errors.psnr_db()));
}

TEST(CompareFiles, ErrorsCoverColoursAndOtherChannelsAreListed) {
  film::Picture a = grey(2, 1, 0.5f), b = a;
  a.planes.push_back({"A", {0, 0}});
  a.planes.push_back({"Z", {1, 7}});
  b.planes.push_back({"Z", {1, 2}});
  b.planes.push_back({"N.X", {0, 0}});
  const Comparison c = of_light(a, b);
  EXPECT_EQ(c.channels, (std::vector<std::string>{"R", "G", "B"}));
  EXPECT_EQ(c.errors.rmse, 0);
  EXPECT_EQ(c.values, 8u);
  EXPECT_EQ(c.differing, 1u);
  EXPECT_EQ(c.only_in_picture, (std::vector<std::string>{"A"}));
  EXPECT_EQ(c.only_in_reference, (std::vector<std::string>{"N.X"}));
}

TEST(CompareFiles, ComparesASingleLayer) {
  film::Picture a = grey(2, 1, 0.5f), b = a;
  a.planes.push_back({"Z", {1, 7}});
  b.planes.push_back({"Z", {1, 2}});
  b.planes[0].values = {0, 0};
  const Comparison c = compare(a, b, Encoding::kLight, "Z");
  EXPECT_EQ(c.channels, (std::vector<std::string>{"Z"}));
  EXPECT_EQ(c.values, 2u);
  EXPECT_EQ(c.differing, 1u) << "R is of another layer";
  EXPECT_EQ(c.errors.max, 5);
  EXPECT_DOUBLE_EQ(c.errors.rmse, std::sqrt(12.5));
  EXPECT_FALSE(c.flip);
  try {
    compare(a, b, Encoding::kLight, "depth");
    FAIL();
  } catch (const base::Error& error) {
    EXPECT_STREQ(error.what(), "layer depth is not in both images; the first has R, G, B, Z");
  }
}

TEST(CompareFiles, PixelsWithoutAHitAreLeftOut) {
  film::Picture a = grey(4, 1, 0.5f), b = a;
  a.planes.push_back({"Z", {1, 7, 1e30f, 1e30f}});
  b.planes.push_back({"Z", {1, 5, 1e30f, 9}});
  const Comparison c = compare(a, b, Encoding::kLight, "Z");
  EXPECT_EQ(c.errors.max, 2);
  EXPECT_DOUBLE_EQ(c.errors.rmse, std::sqrt(2));
  EXPECT_EQ(c.no_hit, 2u);
  EXPECT_EQ(c.no_hit_in_one, 1u);
  EXPECT_NE(comparison_text(c).find("left out    2 pixels without a hit, 1 of them in one image only\n"),
            std::string::npos);
  EXPECT_EQ(nlohmann::json::parse(comparison_json(c))["no_hit_in_one"], 1);
  // Two images without any hit are equal. If only one of them has no hit, there is nothing to compare.
  a.planes.back().values = b.planes.back().values = std::vector<float>(4, 1e30f);
  EXPECT_EQ(compare(a, b, Encoding::kLight, "Z").errors.rmse, 0);
  b.planes.back().values = {1, 2, 3, 4};
  EXPECT_THROW(compare(a, b, Encoding::kLight, "Z"), base::Error);
}

TEST(CompareFiles, ImagesWithoutFiniteValuesAreRefused) {
  const film::Picture bad = grey(2, 2, std::nanf(""));
  try {
    of_light(bad, bad);
    FAIL();
  } catch (const base::Error& error) {
    EXPECT_EQ(error.kind(), base::ErrorKind::kBadData);
    EXPECT_STREQ(error.what(), "nothing to compare: no value of R, G, B is finite and a hit in both images");
  }
  film::Picture half_bad = grey(2, 2, 0.5f);
  half_bad.planes[0].values[0] = std::nanf("");
  EXPECT_EQ(of_light(half_bad, grey(2, 2, 0.5f)).errors.not_finite, 1u);
}

/// Known: computed by hand. The order of the ids does not matter, and the background counts as an object.
TEST(CompareFiles, ACryptomatteIsComparedByCoverage) {
  film::Picture a = grey(3, 1, 0.5f), b = a;
  const auto add = [](film::Picture& p, const std::vector<std::vector<float>>& planes) {
    const char* const names[] = {"R", "G", "B", "A"};
    for (std::size_t i = 0; i < 4; ++i) p.planes.push_back({std::string("CryptoObject00.") + names[i], planes[i]});
  };
  add(a, {{7, 7, 7}, {0.75f, 1, 1}, {8, 0, 0}, {0.25f, 0, 0}});
  add(b, {{8, 7, 0}, {0.5f, 1, 0}, {7, 0, 0}, {0.5f, 0, 0}});
  const Comparison c = compare(a, b, Encoding::kLight, "CryptoObject");
  EXPECT_EQ(c.channels, (std::vector<std::string>{"CryptoObject"}));
  EXPECT_EQ(c.errors.max, 1) << "a sphere in one image, background in the other";
  EXPECT_DOUBLE_EQ(c.errors.mae, 1.25 / 3);
  EXPECT_NE(comparison_text(c).find("matte       0.416667 of the coverage belongs to different objects"),
            std::string::npos);
  EXPECT_EQ(compare(a, a, Encoding::kLight, "CryptoObject").errors.max, 0);
  EXPECT_THROW(compare(a, grey(3, 1, 0.5f), Encoding::kLight, "CryptoObject"), base::Error);
}

TEST(CompareFiles, ChannelsAreSummarisedByLayer) {
  EXPECT_EQ(channels_text({"Z"}), "Z");
  EXPECT_EQ(channels_text({"A", "N.X", "N.Y", "N.Z", "CryptoObject00.R", "CryptoObject01.R"}),
            "A, N (3), CryptoObject (2)");
  std::vector<std::string> many;
  for (int i = 0; i < 10; ++i) many.push_back("layer" + std::to_string(i) + ".R");
  EXPECT_EQ(channels_text(many), "layer0, layer1, layer2, layer3, layer4, layer5, layer6, layer7 and 2 more layers");
}

TEST(CompareFiles, TheResultDoesNotDependOnThreads) {
  film::Picture a = grey(40, 30, 0.5f);
  for (std::size_t i = 0; i < a.planes[0].values.size(); ++i)
    a.planes[i % 3].values[i] = 100.0f / static_cast<float>(i + 1);
  const film::Picture b = grey(40, 30, 0.4f);
  EXPECT_EQ(compare(a, b, Encoding::kLight, "", 1).flip_map.values,
            compare(a, b, Encoding::kLight, "", 3).flip_map.values);
}

TEST(CompareFiles, AnUnavailableMetricIsAnError) {
  const Comparison c = of_light(grey(2, 1, 0.5f), grey(2, 1, 0.25f));
  EXPECT_DOUBLE_EQ(c.metric("mae"), 0.25);
  EXPECT_DOUBLE_EQ(c.metric("bias"), 1);
  EXPECT_GT(c.metric("flip"), 0);
  EXPECT_THROW(c.metric("z"), base::Error);
}

TEST(CompareFiles, DifferentSizesAndChannelsAreRefused) {
  EXPECT_THROW(of_light(grey(2, 1, 0), grey(1, 2, 0)), base::Error);
  film::Picture other = grey(2, 1, 0);
  for (auto& plane : other.planes) plane.name += "2";
  EXPECT_THROW(of_light(grey(2, 1, 0), other), base::Error);
}

TEST(CompareFiles, SceneLinearIsNotComparedToDisplayEncoded) {
  const support::TempDir folder;
  image::write_exr(folder / "a.exr", grey(4, 4, 0.5f), {}, {});
  image::write_encoded(folder / "a.png", {4, 4, 8, true, std::vector<std::uint16_t>(48, 128)}, "");
  try {
    compare_files(folder / "a.png", folder / "a.exr", "", {});
    FAIL();
  } catch (const base::Error& error) {
    EXPECT_EQ(error.kind(), base::ErrorKind::kUsage);
    EXPECT_NE(std::string(error.what()).find("orrery develop " + (folder / "a.exr").string()), std::string::npos);
  }
  EXPECT_EQ(compare_files(folder / "a.exr", folder / "a.exr", "", {}).differing, 0u);
}

TEST(CompareFiles, TextShowsTheLocationOfTheMaximum) {
  film::Picture a = grey(2, 1, 0.5f);
  a.planes[2].values[1] = 0.75f;
  const std::string text = comparison_text(of_light(a, grey(2, 1, 0.5f)));
  for (const char* line : {"images      2 x 1, channels R, G, B\n", "rmse        0.102062\n", "relmse      0.0400641\n",
                           "mae         0.0416667\n", "max         0.25 in B at 1, 0\n", "psnr        19.82 dB\n",
                           "bias        +0.0833 of the mean\n", "differing   1 of 6 values\n"})
    EXPECT_NE(text.find(line), std::string::npos) << line << text;
}

TEST(CompareFiles, JsonHasNullForInfinity) {
  const auto json = nlohmann::json::parse(comparison_json(of_light(grey(2, 1, 0.5f), grey(2, 1, 0.5f))));
  EXPECT_EQ(json["schema"], "orrery.compare/2");
  EXPECT_TRUE(json["psnr_db"].is_null());
  EXPECT_TRUE(json["max_at"].is_null());
  EXPECT_EQ(json["rmse"], 0);
}

TEST(CompareFiles, WritesDifferenceImages) {
  const support::TempDir folder;
  film::Picture a = grey(2, 1, 0.5f);
  a.planes[2].values[1] = 0.25f;
  image::ExrOptions exact;
  exact.as_float = true;
  image::write_exr(folder / "a.exr", a, {}, exact);
  image::write_exr(folder / "b.exr", grey(2, 1, 0.5f), {}, exact);
  compare_files(folder / "a.exr", folder / "b.exr", "", {folder / "d.exr", folder / "heat.png", folder / "flip.png"});
  EXPECT_EQ(image::read(folder / "d.exr").find("B")->values, (std::vector<float>{0, -0.25f}));
  const film::Picture heat = image::read(folder / "heat.png"), flip = image::read(folder / "flip.png");
  EXPECT_LT(heat.find("R")->values[0], 0.01f);
  EXPECT_GT(heat.find("R")->values[1], 0.9f);
  EXPECT_GT(flip.find("R")->values[1], 0.1f);
  compare_files(folder / "a.exr", folder / "b.exr", "", {folder / "d.png", {}, {}});
  EXPECT_NEAR(image::read(folder / "d.png").find("B")->values[1], 0.375, 0.003);
}

}  // namespace
}  // namespace orrery::compare
