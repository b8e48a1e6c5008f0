// SPDX-License-Identifier: Apache-2.0
#include "denoise/light_layers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace orrery::denoise {
namespace {

float sum_of(const std::vector<float>& cells) {
  float sum = 0;
  for (const float cell : cells) sum += cell;
  return sum;
}

TEST(DenoiseLightLayers, CellsAddUpToTheBeautyInAnyOrderAndShareItsSign) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (int run = 0; run < 20'000; ++run) {
    std::vector<double> cells(1 + random() % 7);
    for (double& cell : cells) cell = normal(random) * std::ldexp(1.0, static_cast<int>(random() % 40) - 30);
    // Also far below what the cells are, as where a regression overshoots.
    const auto beauty = static_cast<float>(normal(random) * std::ldexp(1.0, static_cast<int>(random() % 60) - 50));
    round_to_sum(cells, beauty, true);
    std::vector<float> floats(cells.begin(), cells.end());
    for (const float cell : floats) ASSERT_GE(cell * (beauty < 0 ? -1 : 1), 0) << run;
    for (int order = 0; order < 3; ++order) {
      ASSERT_EQ(sum_of(floats), beauty) << run;
      std::shuffle(floats.begin(), floats.end(), random);
    }
  }
}

TEST(DenoiseLightLayers, CellsOfSomeLayersOnlyStayBelowTheBeauty) {
  std::vector<double> cells = {0.25, 0.125};
  round_to_sum(cells, 1, false);
  EXPECT_EQ(cells, (std::vector<double>{0.25, 0.125}));
  round_to_sum(cells, 0.1875F, false);
  EXPECT_EQ(cells, (std::vector<double>{0.125, 0.0625}));
}

}  // namespace
}  // namespace orrery::denoise
