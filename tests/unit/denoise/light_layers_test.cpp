// SPDX-License-Identifier: Apache-2.0
#include "denoise/light_layers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace orrery::denoise {
namespace {

film::Picture with_layers(const std::vector<std::string>& layers) {
  film::Picture picture{1, 1, {}};
  for (const char* letter : {"R", "G", "B"}) picture.planes.push_back({letter, {1}});
  for (const std::string& layer : layers)
    for (const char* letter : {"R", "G", "B"}) picture.planes.push_back({layer + "." + letter, {0.5F}});
  return picture;
}

TEST(DenoiseLightLayers, OnlyLightLayersAreFound) {
  EXPECT_EQ(
      find_light_layers(with_layers({"N", "albedo", "denoise.albedo", "variance", "key", "CryptoObject00"})).names,
      std::vector<std::string>{})
      << "`key` has no lobes, so it is not known to be a light group";
  EXPECT_EQ(find_light_layers(with_layers({"diffuse_direct", "background"})).names,
            (std::vector<std::string>{"background", "diffuse_direct"}));
}

TEST(DenoiseLightLayers, GroupsAndLobesAreSumsOfTheLobesOfGroups) {
  const LightLayers found = find_light_layers(with_layers(
      {"diffuse_direct", "emission", "key", "key_diffuse_direct", "rim", "rim_diffuse_direct", "rim_emission"}));
  ASSERT_EQ(found.channels.size(), 3U);
  EXPECT_EQ(found.channels[1].cells.size(), 3U);
  EXPECT_EQ(found.channels[1].sums.size(), 4U) << "two lobes and two groups";
}

TEST(DenoiseLightLayers, CompletenessIsThatOfEveryPixel) {
  film::Picture picture = with_layers({"diffuse_direct", "specular_direct"});
  EXPECT_TRUE(are_complete(picture, find_light_layers(picture)));
  picture.planes.back().values[0] = 0.4F;
  EXPECT_FALSE(are_complete(picture, find_light_layers(picture)));
}

TEST(DenoiseLightLayers, RoundedCellsAddUpInAnyOrder) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> value(-0.2, 1);
  for (int n = 0; n < 1000; ++n) {
    std::vector<double> cells(7);
    double sum = 0;
    for (double& cell : cells) sum += cell = n % 2 == 0 ? value(random) : std::abs(value(random)) * 1e-20;
    if (sum <= 0) continue;
    const auto beauty = static_cast<float>(sum);
    round_to_sum(cells, beauty, true);
    std::shuffle(cells.begin(), cells.end(), random);
    float total = 0;
    for (const double cell : cells) {
      EXPECT_GE(cell, 0);
      EXPECT_EQ(static_cast<double>(static_cast<float>(cell)), cell);
      total += static_cast<float>(cell);
    }
    EXPECT_EQ(total, beauty);
  }
}

TEST(DenoiseLightLayers, ExtremeCellsAreHandled) {
  std::vector<double> cells = {-1, 0};
  round_to_sum(cells, 0.5F, true);
  EXPECT_EQ(cells[0] + cells[1], 0.5) << "light below zero everywhere";
  cells = {0.25, 0.125};
  round_to_sum(cells, 0.5F, false);
  EXPECT_EQ(cells, (std::vector<double>{0.25, 0.125})) << "the rest has no layer";
  round_to_sum(cells, 0, true);
  EXPECT_EQ(cells, (std::vector<double>{0, 0}));
  cells = {-0.25, -0.5};
  round_to_sum(cells, -0.8F, true);
  EXPECT_EQ(static_cast<float>(cells[0]) + static_cast<float>(cells[1]), -0.8F);
}

}  // namespace
}  // namespace orrery::denoise
