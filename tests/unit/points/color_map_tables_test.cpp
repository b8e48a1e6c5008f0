// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "color_difference.h"

namespace orrery::points {
namespace {

TEST(PointsColorMapTables, ColorsAreThoseOfThePublishedTables) {
  // tools/color_maps.py compares all entries; these rows show that the committed knots are its output. Rows of tables
  // in 8 bits are 0 to 255.
  struct Row {
    const char* map;
    int index;
    Vec3d srgb;
  };
  const Row rows[] = {
      {"viridis", 0, {0.267004, 0.004874, 0.329415}},   {"viridis", 128, {0.127568, 0.566949, 0.550556}},
      {"viridis", 255, {0.993248, 0.906157, 0.143936}}, {"inferno", 63, {0.335217, 0.06006, 0.428524}},
      {"inferno", 129, {0.741423, 0.219112, 0.326576}}, {"inferno", 189, {0.974176, 0.53678, 0.048392}},
      {"magma", 0, {0.001462, 0.000466, 0.013866}},     {"magma", 255, {0.987053, 0.991438, 0.749504}},
      {"plasma", 0, {0.050383, 0.029803, 0.527975}},    {"plasma", 255, {0.940015, 0.975158, 0.131326}},
      {"cividis", 0, {0, 0.135112, 0.304751}},          {"cividis", 255, {0.995737, 0.909344, 0.217772}},
      {"turbo", 0, {0.18995, 0.07176, 0.23217}},        {"turbo", 128, {0.64362, 0.98999, 0.23356}},
      {"turbo", 255, {0.4796, 0.01583, 0.01055}},       {"batlow", 0, {0.0051932, 0.098238, 0.34984}},
      {"batlow", 64, {0.1333, 0.37528, 0.3794}},        {"batlow", 128, {0.51125, 0.5109, 0.1933}},
      {"batlow", 192, {0.9507, 0.61665, 0.42862}},      {"batlow", 255, {0.98135, 0.80041, 0.98127}},
      {"fast", 22, Vec3d{44, 67, 163} / 255},           {"fast", 66, Vec3d{84, 167, 232} / 255},
      {"fast", 128, Vec3d{230, 240, 195} / 255},        {"fast", 200, Vec3d{219, 121, 58} / 255},
      {"fast", 255, Vec3d{150, 20, 30} / 255},          {"coolwarm", 0, Vec3d{59, 76, 192} / 255},
      {"coolwarm", 64, Vec3d{141, 176, 254} / 255},     {"coolwarm", 230, Vec3d{214, 82, 68} / 255},
      {"coolwarm", 255, Vec3d{180, 4, 38} / 255},
  };
  for (const Row& row : rows)
    EXPECT_LT(difference(srgb_at(*find_color_map(row.map), row.index / 255.0), row.srgb), 1) << row.map << row.index;
}

TEST(PointsColorMapTables, CategoricalColors) {
  const ColorMap& tab10 = *find_color_map("tab10");
  ASSERT_EQ(tab10.knots.size(), 10u);
  EXPECT_EQ(find_color_map("okabe-ito")->knots.size(), 8u);
  EXPECT_EQ(find_color_map("set2")->knots.size(), 8u);
  EXPECT_LT(difference(tab10.knots[0].srgb, Vec3d{31, 119, 180} / 255), 1e-9);
  EXPECT_LT(difference(tab10.knots[9].srgb, Vec3d{23, 190, 207} / 255), 1e-9);
  EXPECT_EQ(srgb_at(tab10, 0.05), tab10.knots[0].srgb);
  EXPECT_EQ(srgb_at(tab10, 0.15), tab10.knots[1].srgb);
  const std::vector<Vec3d> colors = palette(tab10, 12);
  EXPECT_EQ(colors[3], linear_from_srgb(tab10.knots[3].srgb)) << "no interpolation";
  EXPECT_EQ(colors[11], colors[1]);
}

}  // namespace
}  // namespace orrery::points
