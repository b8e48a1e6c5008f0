// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "support/mentions.h"
#include "unit/compare/grey.h"

namespace orrery::compare {
namespace {

TEST(CompareComparedChannels, ErrorsCoverColoursAndOtherChannelsAreListed) {
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

TEST(CompareComparedChannels, ComparesASingleLayer) {
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
    EXPECT_TRUE(test::mentions(error.what(), {"layer depth", "first has R, G, B, Z"}));
  }
}

TEST(CompareComparedChannels, PixelsWithoutAHitAreLeftOut) {
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

/// Known: computed by hand. The order of the ids does not matter, and the background counts as an object.
TEST(CompareComparedChannels, ACryptomatteIsComparedByCoverage) {
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

TEST(CompareComparedChannels, DifferentSizesAndChannelsAreRefused) {
  EXPECT_THROW(of_light(grey(2, 1, 0), grey(1, 2, 0)), base::Error);
  film::Picture other = grey(2, 1, 0);
  for (auto& plane : other.planes) plane.name += "2";
  EXPECT_THROW(of_light(grey(2, 1, 0), other), base::Error);
}

}  // namespace
}  // namespace orrery::compare
