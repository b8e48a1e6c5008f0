// SPDX-License-Identifier: Apache-2.0
#include "plot/appearance.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "plot/plot.h"
#include "support/mentions.h"
#include "support/temp_dir.h"

namespace orrery::plot {
namespace {

class PlotAppearance : public testing::Test {
 protected:
  /// The choices for a file, a line each.
  std::string choose(const std::string& name, const std::string& text) {
    options_.file = folder_ / name;
    support::write_bytes(options_.file, text);
    points_ = options_.points;
    const DataFrames frames(options_, folder_.path());
    std::string out;
    for (const std::string& choice : choose_appearance(options_, frames, points_)) out += choice + "\n";
    return out;
  }
  /// Sets the colour keys for a column, or a word, of data with a few columns.
  scene::PointsColor colored_by(const std::string& name) {
    data::FrameInfo info;
    info.columns = {{"type", data::ColumnType::kInt32},
                    {"element", data::ColumnType::kText},
                    {"chain_name", data::ColumnType::kText},
                    {"mass", data::ColumnType::kFloat64}};
    info.roles.type = "type";
    info.roles.element = "element";
    info.roles.chain = "chain_name";
    scene::PointsColor out;
    set_color(options_, name, info, out);
    return out;
  }

  support::TempDir folder_;
  PlotOptions options_;
  scene::PointsKeys points_;
};

const std::string kWater = "3\n\nO 0 0 0\nH 0.96 0 0\nH -0.24 0.93 0\n";

TEST_F(PlotAppearance, ChoicesArePrintedInTheOrderOfTheScene) {
  EXPECT_TRUE(test::mentions(choose("a.xyz", kWater), {"radius vdw", "colour by element"}));
  EXPECT_EQ(points_.radius.element, "vdw");
  EXPECT_EQ(points_.color.element, "soft");
  EXPECT_FALSE(points_.bonds.are_drawn);
}

TEST_F(PlotAppearance, WhatTheUserHasSetIsKeptAndNotPrinted) {
  options_.points.radius.value = 0.3;
  options_.representation = Representation::kSticks;
  options_.color_by = "none";
  EXPECT_EQ(choose("a.xyz", kWater), "");
  EXPECT_EQ(points_.radius.value, 0.3);
  EXPECT_TRUE(points_.bonds.are_drawn);
  EXPECT_EQ(points_.bonds.radius, 0.3) << "sticks have one radius";
}

TEST_F(PlotAppearance, SpheresWithoutElementsTouchTheirNeighbors) {
  EXPECT_TRUE(test::mentions(choose("a.csv", "x,y,z\n0,0,0\n0,0,3\n0,9,0\n"), {"radius 1.5", "no colour"}));
  EXPECT_EQ(points_.radius.value, 1.5);
  options_.points.radius.scale = 2;
  choose("a.csv", "x,y,z\n0,0,0\n0,0,3\n0,9,0\n");
  EXPECT_EQ(points_.radius.value, 3);
}

TEST_F(PlotAppearance, AUnitCellIsShownUnlessTheUserChoosesOtherwise) {
  data::FrameInfo info;
  info.is_unit_cell = true;
  info.roles.element = "element";
  EXPECT_TRUE(shows_cell(options_, info));
  options_.bonds = true;
  EXPECT_FALSE(shows_cell(options_, info));
  options_.bonds.reset();
  info.roles.element.clear();
  EXPECT_FALSE(shows_cell(options_, info)) << "of coarse-grained particles";
}

TEST_F(PlotAppearance, ColorsFollowTheKindOfColumn) {
  EXPECT_EQ(colored_by("mass").map, "fast");
  EXPECT_EQ(colored_by("chain_name").map, "set2");
  EXPECT_EQ(colored_by("type").column, "type");
  EXPECT_EQ(colored_by("element").element, "soft");
  const scene::PointsColor by_chain = colored_by("chain+element");
  EXPECT_EQ(by_chain.element, "soft");
  EXPECT_EQ(by_chain.carbon, "chain_name");
  EXPECT_TRUE(colored_by("rgb").rgb);
  EXPECT_FALSE(colored_by("none").is_set());
}

TEST_F(PlotAppearance, AMapOrARangeWithoutEffectIsRefused) {
  options_.has_map = true;
  EXPECT_THROW(colored_by("none"), base::Error);
  EXPECT_EQ(colored_by("element").column, "element") << "with a map, elements are values";
  options_.has_map = false;
  options_.range.is_set = true;
  EXPECT_THROW(colored_by("element"), base::Error);
  EXPECT_THROW(colored_by("chain_name"), base::Error) << "a colour for each value";
  EXPECT_EQ(colored_by("mass").column, "mass");
}

}  // namespace
}  // namespace orrery::plot
