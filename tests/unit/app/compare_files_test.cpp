// SPDX-License-Identifier: Apache-2.0
#include "app/compare_files.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "image/write.h"
#include "support/scratch_folder.h"

namespace orrery::app {
namespace {

film::Picture grey(int width, int height, float value) {
  const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  film::Picture picture{width, height, {}};
  for (const char* name : {"R", "G", "B"}) picture.planes.push_back({name, std::vector<float>(pixels, value)});
  return picture;
}

TEST(AppCompareFiles, EqualPicturesDoNotDiffer) {
  const Comparison c = compare(grey(4, 3, 0.5f), grey(4, 3, 0.5f));
  EXPECT_EQ(c.rmse, 0);
  EXPECT_EQ(c.relative_mse, 0);
  EXPECT_EQ(c.max, 0);
  EXPECT_EQ(c.differing, 0u);
  EXPECT_EQ(c.max_channel, "");
  EXPECT_TRUE(std::isinf(c.psnr_db()));
}

TEST(AppCompareFiles, MetricsAreWhatTheirNamesSay) {
  film::Picture a = grey(2, 2, 0.5f);
  a.planes[1].values[2] = 1.0f;  // G at (0, 1): 0.5 more, in one value of twelve
  a.planes[2].values[3] = 0.25f;
  const Comparison c = compare(a, grey(2, 2, 0.5f));
  const double sum = 0.5 * 0.5 + 0.25 * 0.25;
  EXPECT_DOUBLE_EQ(c.rmse, std::sqrt(sum / 12));
  EXPECT_DOUBLE_EQ(c.relative_mse, sum / (0.25 + kRelativeFloor) / 12);
  EXPECT_DOUBLE_EQ(c.psnr_db(), -10 * std::log10(sum / 12));
  EXPECT_EQ(c.max, 0.5);
  EXPECT_EQ(c.max_channel, "G");
  EXPECT_EQ(c.max_x, 0);
  EXPECT_EQ(c.max_y, 1);
  EXPECT_EQ(c.differing, 2u);
}

TEST(AppCompareFiles, RelativeErrorIsOfTheReference) {
  const double bright = compare(grey(1, 1, 1), grey(1, 1, 10)).relative_mse;
  const double dark = compare(grey(1, 1, 10), grey(1, 1, 1)).relative_mse;
  EXPECT_DOUBLE_EQ(bright, 81 / 100.01);
  EXPECT_DOUBLE_EQ(dark, 81 / 1.01);
}

TEST(AppCompareFiles, ValuesThatAreNotFiniteAreLeftOutAndCounted) {
  film::Picture a = grey(2, 1, 0.5f), b = a;
  a.planes[0].values[0] = std::numeric_limits<float>::quiet_NaN();
  b.planes[1].values[1] = std::numeric_limits<float>::infinity();
  const Comparison c = compare(a, b);
  EXPECT_EQ(c.not_finite, 2u);
  EXPECT_EQ(c.rmse, 0);
  EXPECT_EQ(c.max, 0);
}

TEST(AppCompareFiles, OnlyCommonChannelsCount) {
  film::Picture a = grey(2, 1, 0.5f);
  a.planes.push_back({"A", {0, 0}});
  EXPECT_EQ(compare(a, grey(2, 1, 0.5f)).channels, (std::vector<std::string>{"R", "G", "B"}));
}

TEST(AppCompareFiles, WhatCannotBeComparedIsRefused) {
  EXPECT_THROW(compare(grey(2, 1, 0), grey(1, 2, 0)), base::Error);
  film::Picture other = grey(2, 1, 0);
  for (auto& plane : other.planes) plane.name += "2";
  EXPECT_THROW(compare(grey(2, 1, 0), other), base::Error);
}

TEST(AppCompareFiles, LightIsNotComparedToWhatADisplayShows) {
  const support::ScratchFolder folder;
  image::write_exr(folder / "a.exr", grey(4, 4, 0.5f), {}, {});
  image::write_encoded(folder / "a.png", {4, 4, 8, true, std::vector<std::uint16_t>(48, 128)}, "");
  try {
    compare_files(folder / "a.png", folder / "a.exr");
    FAIL();
  } catch (const base::Error& error) {
    EXPECT_EQ(error.kind(), base::ErrorKind::kUsage);
    EXPECT_NE(std::string(error.what()).find("orrery develop " + (folder / "a.exr").string()), std::string::npos);
  }
  EXPECT_EQ(compare_files(folder / "a.exr", folder / "a.exr").differing, 0u);
}

TEST(AppCompareFiles, TextNamesTheWorstPixel) {
  film::Picture a = grey(2, 1, 0.5f);
  a.planes[2].values[1] = 0.75f;
  EXPECT_EQ(comparison_text(compare(a, grey(2, 1, 0.5f))),
            "pictures    2 x 1, channels R, G, B\n"
            "rmse        0.102062\n"
            "relmse      0.0400641\n"
            "max         0.25 in B at 1, 0\n"
            "psnr        19.82 dB\n"
            "differing   1 of 6 values\n");
}

TEST(AppCompareFiles, JsonHasNoInfinity) {
  const auto json = nlohmann::json::parse(comparison_json(compare(grey(2, 1, 0.5f), grey(2, 1, 0.5f))));
  EXPECT_EQ(json["schema"], "orrery.compare/1");
  EXPECT_TRUE(json["psnr_db"].is_null());
  EXPECT_TRUE(json["max_at"].is_null());
  EXPECT_EQ(json["rmse"], 0);
}

}  // namespace
}  // namespace orrery::app
