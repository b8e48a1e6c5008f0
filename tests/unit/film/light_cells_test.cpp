// SPDX-License-Identifier: Apache-2.0
#include "film/light_cells.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "base/image_limits.h"
#include "unit/film/pixel_of_layers.h"

namespace orrery::film {
namespace {

using FilmLightCells = PixelOfLayers;

/// Adds `values` in single precision in several orders and expects the same sum each time.
void expect_sum(std::vector<float> values, float sum, std::mt19937& random, const std::string& what) {
  for (int order = 0; order < 4; ++order) {
    float total = 0;
    for (const float v : values) {
      ASSERT_GE(v, 0) << what;
      total += v;
    }
    ASSERT_EQ(total, sum) << what;
    std::shuffle(values.begin(), values.end(), random);
  }
}

/// Random light in random lobes and groups: the lobes, the groups, and the lobes of the groups each add up to the
/// beauty, the lobes of a group to the group, and the parts of a lobe to the lobe.
TEST_F(FilmLightCells, LightAddsUpToTheBeautyInAnyOrder) {
  request_.diffuse = request_.specular = request_.transmission = request_.background = request_.emission = true;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  // Magnitudes: of common images, below the unit of the sums (2^-60), near the largest sample, and all of these.
  const std::pair<double, double> exponents[] = {{-30, 12}, {-68, -55}, {15, 30}, {-70, 31}};
  for (int trial = 0; trial < 3000; ++trial) {
    clear();
    request_.light_groups = trial % 4 != 0;
    request_.groups.assign(1 + random() % (trial % 50 == 1 ? base::kMaxLightGroups : 4), {"", true, true});
    for (std::size_t g = 0; g < request_.groups.size(); ++g) request_.groups[g].name = "g" + std::to_string(g);
    const auto [low, high] = exponents[trial / 4 % 4];
    std::uniform_real_distribution<double> exponent(low, high);
    // Single precision as in the fast kernel, whose rounded path sums differ from the sum of the events.
    const bool is_fast = random() % 2 == 0;
    const int paths = 1 + static_cast<int>(uniform(random) * 40);
    for (int i = 0; i < paths; ++i) {
      kernel::PathRecord path = path_to(0);
      std::vector<kernel::LightEvent> events(random() % 6);
      for (kernel::LightEvent& e : events) {
        e.lobe = static_cast<kernel::Lobe>(random() % kernel::kLobes);
        e.group = static_cast<std::uint16_t>(random() % request_.groups.size());
        for (int c = 0; c < 3; ++c) {
          e.value[c] = uniform(random) < 0.2 || (c == 2 && trial % 3 == 0) ? 0 : std::exp2(exponent(random));
          if (is_fast) e.value[c] = static_cast<float>(e.value[c]);
          path.light[c] += e.value[c];
          if (is_fast) path.light[c] = static_cast<float>(path.light[c]);
        }
      }
      add(path, events);
    }
    const Picture p = picture();
    for (int c = 0; c < 3; ++c) {
      const std::string channel = std::string(".") + "RGB"[c], what = "trial " + std::to_string(trial) + channel;
      const auto whole = static_cast<float>(mean(beauty().rgb[c], beauty().weight));
      std::vector<float> lobes, groups, products;
      for (const char* lobe : kLobeNames) {
        lobes.push_back(value(p, lobe + channel));
        std::vector<float> parts;
        for (const LightGroup& g : request_.groups)
          if (request_.light_groups) parts.push_back(value(p, g.name + "_" + lobe + channel));
        if (request_.light_groups) expect_sum(parts, lobes.back(), random, what);
        products.insert(products.end(), parts.begin(), parts.end());
      }
      expect_sum(lobes, whole, random, what);
      if (!request_.light_groups) continue;
      for (const LightGroup& g : request_.groups) {
        groups.push_back(value(p, g.name + channel));
        std::vector<float> parts;
        for (const char* lobe : kLobeNames) parts.push_back(value(p, g.name + "_" + lobe + channel));
        expect_sum(parts, groups.back(), random, what);
      }
      expect_sum(groups, whole, random, what);
      expect_sum(products, whole, random, what);
    }
    if (HasFatalFailure()) return;
  }
}

/// The rounding errors of the layers, in units of the whole's last bit, and cells without light.
TEST_F(FilmLightCells, LightIsRoundedToTheLastBitOfTheBeauty) {
  request_.diffuse = request_.emission = request_.light_groups = true;
  request_.groups = {{"a", true, true}, {"b", true, true}, {"c", true, true}};
  std::mt19937 random(2);
  std::uniform_real_distribution<double> uniform(0, 1);
  double of_cells = 0, of_lobes = 0, of_groups = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    clear();
    double cells[3][kernel::kLobes] = {};
    kernel::PathRecord path = path_to(0);
    std::vector<kernel::LightEvent> events;
    for (std::uint16_t g = 0; g < 2; ++g) {
      for (int lobe = 1; lobe < kernel::kLobes; ++lobe) {
        const double light = uniform(random);
        // The radiance of the path has a relative rounding error, as in single precision; all cells share it.
        cells[g][lobe] = light * (1 + 0x1p-21);
        path.light[0] += cells[g][lobe];
        events.push_back({{light, 0, 0}, 0, g, static_cast<kernel::Lobe>(lobe)});
      }
    }
    add(path, events);
    const Picture p = picture();
    const double unit = std::ldexp(1, std::ilogb(static_cast<float>(path.light[0])) - 23);
    for (std::size_t g = 0; g < 3; ++g) {
      double sum = 0;
      for (int lobe = 0; lobe < kernel::kLobes; ++lobe) {
        const float v = value(p, request_.groups[g].name + "_" + kLobeNames[lobe] + ".R");
        sum += cells[g][lobe];
        of_cells = std::max(of_cells, std::abs(v - cells[g][lobe]) / unit);
        if (cells[g][lobe] == 0) {
          ASSERT_EQ(v, 0);
        }
      }
      of_groups = std::max(of_groups, std::abs(value(p, request_.groups[g].name + ".R") - sum) / unit);
    }
    for (int lobe : {1, 2, 7})
      of_lobes = std::max(
          of_lobes, std::abs(value(p, kLobeNames[lobe] + std::string(".R")) - cells[0][lobe] - cells[1][lobe]) / unit);
  }
  EXPECT_LT(of_cells, 1.001);
  EXPECT_LT(of_lobes, 1.001);
  EXPECT_LT(of_groups, 8);
  EXPECT_GT(of_cells, 0.9) << "as documented";
}

/// Paths whose rounded sums differ from their events, where the mean of a pixel is half way between two floats and the
/// rounding of that difference decides.
TEST_F(FilmLightCells, RoundingErrorsNeitherLoseTheLastBitNorMakeLightNegative) {
  request_.diffuse = true;
  const kernel::Int128 half_way = (kernel::Int128{1} << 60) + (kernel::Int128{1} << 36);  // 1 + 2^-24
  beauty() = {{3 * half_way + 512, 0, 0}, 3};
  sums().layers.light[1][0] = beauty().rgb[0] - 300;
  EXPECT_EQ(value(picture(), "diffuse_direct.R"), 1 + 0x1p-23F);
  beauty() = {{3 * half_way, 0, 0}, 3};
  sums().layers.light[1][0] = beauty().rgb[0] + 300;
  sums().layers.light[2][0] = 1;
  EXPECT_EQ(value(picture(), "diffuse_direct.R"), 1);
  EXPECT_EQ(value(picture(), "diffuse_indirect.R"), 0);
}

/// A lobe layer has the same bits whether or not light groups are requested.
TEST_F(FilmLightCells, LightGroupsDoNotChangeTheLobes) {
  request_.diffuse = request_.specular = request_.background = request_.emission = true;
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform(0, 1);
  for (int trial = 0; trial < 300; ++trial) {
    kernel::PathRecord path = path_to(0);
    std::vector<kernel::LightEvent> events(1 + random() % 9);
    float sum = 0;
    for (kernel::LightEvent& e : events) {
      const float light = uniform(random);
      e = {{light, light, light}, 0, static_cast<std::uint16_t>(random() % 3), static_cast<kernel::Lobe>(random() % 8)};
      sum += light;
    }
    std::fill_n(path.light, 3, double{sum});
    Picture pictures[2];
    for (const bool with_groups : {false, true}) {
      clear();
      request_.light_groups = with_groups;
      request_.groups.assign(with_groups ? 3 : 0, {"g", true, true});
      add(path, events);
      pictures[with_groups] = picture();
    }
    for (const Plane& plane : pictures[0].planes) EXPECT_EQ(plane.values, pictures[1].find(plane.name)->values);
  }
}

}  // namespace
}  // namespace orrery::film
