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
#include "support/mentions.h"
#include "support/temp_dir.h"
#include "unit/compare/grey.h"

namespace orrery::compare {
namespace {

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

TEST(CompareFiles, ImagesWithoutFiniteValuesAreRefused) {
  const film::Picture bad = grey(2, 2, std::nanf(""));
  try {
    of_light(bad, bad);
    FAIL();
  } catch (const base::Error& error) {
    EXPECT_EQ(error.kind(), base::ErrorKind::kBadData);
    EXPECT_TRUE(test::mentions(error.what(), {"R, G, B", "finite"}));
  }
  film::Picture half_bad = grey(2, 2, 0.5f);
  half_bad.planes[0].values[0] = std::nanf("");
  EXPECT_EQ(of_light(half_bad, grey(2, 2, 0.5f)).errors.not_finite, 1u);
}

TEST(CompareFiles, LayersAreListedOnce) {
  EXPECT_EQ(layers_of({"A", "N.X", "N.Y", "N.Z", "Z", "CryptoObject00.R", "CryptoObject01.R"}),
            (std::vector<std::string>{"A", "N", "Z", "CryptoObject"}));
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

TEST(CompareFiles, WritesErrorMaps) {
  const support::TempDir folder;
  film::Picture a = grey(2, 1, 0.5f);
  a.planes[2].values[1] = 0.25f;
  image::ExrOptions exact;
  exact.as_float = true;
  image::write_exr(folder / "a.exr", a, {}, exact);
  image::write_exr(folder / "b.exr", grey(2, 1, 0.5f), {}, exact);
  const Comparison found =
      compare_files(folder / "a.exr", folder / "b.exr", "", {folder / "heat.png", folder / "flip.png"});
  const film::Picture heat = image::read(folder / "heat.png"), flip = image::read(folder / "flip.png");
  EXPECT_LT(heat.find("R")->values[0], 0.01f);
  EXPECT_GT(heat.find("R")->values[1], 0.9f);
  EXPECT_GT(flip.find("R")->values[1], 0.1f);
  compare_files(folder / "a.exr", folder / "b.exr", "", {folder / "heat.exr", {}});
  EXPECT_EQ(image::read(folder / "heat.exr").find("B")->values, found.display_map.values);
}

}  // namespace
}  // namespace orrery::compare
