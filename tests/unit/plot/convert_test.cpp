// SPDX-License-Identifier: Apache-2.0
#include "plot/convert.h"

#include <gtest/gtest.h>

#include <vector>

#include "base/error.h"
#include "support/mentions.h"
#include "support/temp_dir.h"

namespace orrery::plot {
namespace {

class PlotConvert : public testing::Test {
 protected:
  void SetUp() override {
    support::write_bytes(
        folder_ / "a.xyz",
        "2\nLattice=\"4 0 0 0 5 0 0 0 6\" Properties=species:S:1:pos:R:3:q:R:1\nC 1 2 3 0\nAr 3 2 1 9\n"
        "1\nProperties=species:S:1:pos:R:3:q:R:1\nC 7 8 9 4\n");
    options_.file = folder_ / "a.xyz";
    options_.output = folder_ / "b.csv";
  }
  /// Converts the file.
  ///
  /// Result     what was written first, with the text of the file
  std::string converted() {
    written_.clear();
    convert(options_, [&](const ConvertedFile& file) { written_.push_back(file); });
    return written_.empty() ? "" : support::file_bytes(written_[0].file);
  }

  support::TempDir folder_;
  ConvertOptions options_;
  std::vector<ConvertedFile> written_;
};

TEST_F(PlotConvert, ColumnsAreThoseOfSpheresThenThoseOfTheFile) {
  options_.points.radius.element = "vdw";
  EXPECT_EQ(converted(), "x,y,z,radius,species,q\n1,2,3,1.7,\"C\",0\n3,2,1,1.88,\"Ar\",9\n");
  EXPECT_EQ(written_.at(0).spheres, 2u);
  EXPECT_EQ(written_[0].columns, (std::vector<std::string>{"x", "y", "z", "radius", "species", "q"}));
  ASSERT_EQ(written_[0].notes.size(), 1u);
  EXPECT_TRUE(test::mentions(written_[0].notes[0], {"box", ".xyz"}));
}

TEST_F(PlotConvert, NoRadiusIsGuessed) {
  EXPECT_EQ(converted().substr(0, 14), "x,y,z,species,");
  EXPECT_TRUE(test::mentions(written_.at(0).notes.at(0), {"radius", "--radius"}));
}

TEST_F(PlotConvert, ColorsOfOneMapAreThoseOfAllFrames) {
  options_.color_by = "q";
  options_.points.color.map = "viridis";
  options_.has_map = true;
  options_.all_frames = true;
  options_.points.select = "q > 0";
  options_.output = folder_ / "b.##.csv";
  converted();
  ASSERT_EQ(written_.size(), 2u);
  const std::string most = support::file_bytes(folder_ / "b.01.csv"), least = support::file_bytes(folder_ / "b.02.csv");
  EXPECT_NE(most.find(",253,231,37,"), std::string::npos) << most;
  EXPECT_NE(least.find(",68,1,84,"), std::string::npos) << least;
}

TEST_F(PlotConvert, TheBoxIsThatOfAllImages) {
  options_.points.replicate = {2, 1, 1};
  options_.output = folder_ / "b.xyz";
  const std::string text = converted();
  EXPECT_NE(text.find("Lattice=\"8 0 0 0 5 0 0 0 6\""), std::string::npos) << text;
  EXPECT_EQ(written_.at(0).spheres, 4u);
}

TEST_F(PlotConvert, OutputsThatCannotBeAreRefused) {
  options_.output = options_.file;
  EXPECT_THROW(converted(), base::Error) << "the input";
  options_.output = folder_ / "b.##.csv";
  EXPECT_THROW(converted(), base::Error) << "a pattern for one frame";
  options_.all_frames = true;
  options_.output = folder_ / "b.csv";
  EXPECT_THROW(converted(), base::Error) << "one name for two frames";
  EXPECT_TRUE(written_.empty());
}

}  // namespace
}  // namespace orrery::plot
