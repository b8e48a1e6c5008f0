// SPDX-License-Identifier: Apache-2.0
#include "plot/data_frames.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "scene/scene.h"
#include "support/mentions.h"
#include "support/temp_dir.h"

namespace orrery::plot {
namespace {

/// Three frames: of no particle, of two, and of three.
class PlotDataFrames : public testing::Test {
 protected:
  void SetUp() override {
    const auto frame = [](const std::string& count, const std::string& rows) {
      return "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n" + count +
             "\nITEM: BOX BOUNDS pp pp pp\n0 9\n0 9\n0 9\nITEM: ATOMS id x y z radius element vx vy vz\n" + rows;
    };
    options_.file = folder_ / "a.dump";
    support::write_bytes(options_.file, frame("0", "") + frame("2", "1 0 0 0 1 C 3 0 0\n2 0 2 0 3 O 0 4 0\n") +
                                            frame("3", "1 0 0 0 1 C 0 0 0\n2 0 1 0 1 C 0 0 0\n3 5 5 5 1 N 0 0 0\n"));
  }
  base::ErrorKind kind_of_error() {
    try {
      DataFrames(options_, folder_.path());
    } catch (const base::Error& error) {
      return error.kind();
    }
    ADD_FAILURE() << "no error";
    return base::ErrorKind::kInternal;
  }

  support::TempDir folder_;
  DataOptions options_;
};

TEST_F(PlotDataFrames, FramesAreCountedFromTheEnd) {
  options_.points.frame = -1;
  const DataFrames frames(options_, folder_.path());
  EXPECT_EQ(frames.fixed_frame(), 3);
  EXPECT_EQ(frames.described_frame(), 3);
  EXPECT_EQ(frames.info().rows, 3u);
  options_.points.frame = -4;
  EXPECT_EQ(kind_of_error(), base::ErrorKind::kBadData);
}

TEST_F(PlotDataFrames, AllFramesAreVisitedOnce) {
  options_.all_frames = true;
  DataFrames frames(options_, folder_.path(), [](const data::FrameInfo&) { return std::vector<std::string>{"x"}; });
  EXPECT_EQ(frames.numbers(), (std::vector<int>{1, 2})) << "more are not known before";
  std::vector<int> visited;
  frames.visit([&](int frame) { visited.push_back(frame); });
  EXPECT_EQ(visited, (std::vector<int>{1, 2, 3}));
  EXPECT_EQ(frames.numbers(), visited);
  EXPECT_EQ(frames.frame_count(), 3);
}

TEST_F(PlotDataFrames, AFrameThatDoesNotExistIsAnError) {
  options_.frames = {2, 4};
  EXPECT_EQ(kind_of_error(), base::ErrorKind::kBadData);
  options_.frames = {};
  options_.points.component = 1;
  EXPECT_EQ(kind_of_error(), base::ErrorKind::kUsage) << "the format has none";
}

TEST_F(PlotDataFrames, AllFramesOfASequenceOfFilesAreARange) {
  support::write_bytes(folder_ / "b.01.csv", "x,y,z\n0,0,0\n");
  options_.file = folder_ / "b.##.csv";
  options_.frames = {1};
  EXPECT_EQ(DataFrames(options_, folder_.path()).file_of(1), folder_ / "b.01.csv");
  options_.all_frames = true;
  EXPECT_EQ(kind_of_error(), base::ErrorKind::kUsage);
}

TEST_F(PlotDataFrames, MeasuresAreThoseOfTheFirstFrameThatHasThem) {
  scene::PointsKeys keys;
  keys.vectors.columns = {"vx", "vy", "vz"};
  const DataFrames frames(options_, folder_.path());
  const Measures all = frames.measures(keys, true, true);
  EXPECT_EQ(all.spacing, 2);
  EXPECT_EQ(all.mean_radius, 2);
  EXPECT_DOUBLE_EQ(all.rms_vector, std::sqrt(12.5));
  EXPECT_EQ(frames.measures({}, false, true).spacing, 0) << "not requested";
}

TEST_F(PlotDataFrames, DistinctValuesAreThoseOfTheDescribedFrame) {
  options_.points.frame = 2;
  const DataFrames frames(options_, folder_.path());
  scene::PointsKeys keys;
  keys.frame = 2;
  keys.select = "id == 1";
  EXPECT_EQ(frames.distinct_values(keys, "element"), (std::vector<std::string>{"C", "O"})) << "whatever is selected";
  EXPECT_EQ(frames.mean_coordination(keys), 0) << "2 is longer than a bond";
}

TEST_F(PlotDataFrames, FaultsNameTheFrameAndTheOption) {
  options_.frames = {2, 3};
  const DataFrames frames(options_, folder_.path());
  scene::PointsKeys keys;
  keys.cryptomatte = {"none"};
  try {
    frames.load(2, keys);
    ADD_FAILURE() << "no error";
  } catch (const base::Error& error) {
    EXPECT_TRUE(test::mentions(error.diagnostics().at(0).text, {"frame 2", "--outline-by", "none"}));
  }
}

TEST_F(PlotDataFrames, ATrajectoryWithoutNamesNeedsATopology) {
  options_.file = ORRERY_ROOT "/tests/fuzz/corpus/data/xtc/water.xtc";
  scene::PointsKeys keys;
  keys.radius.element = "vdw";
  try {
    DataFrames(options_, folder_.path()).load(1, keys);
    ADD_FAILURE() << "no error";
  } catch (const base::Error& error) {
    std::string all;
    for (const base::Diagnostic& d : error.diagnostics()) all += d.text + "\n";
    EXPECT_TRUE(test::mentions(all, {"radius.element", "--topology"}));
  }
}

TEST_F(PlotDataFrames, AllConditionsApply) {
  EXPECT_EQ(all_of({}), "");
  EXPECT_EQ(all_of({"x > 0 || y > 0"}), "x > 0 || y > 0");
  EXPECT_EQ(all_of({"x > 0 || y > 0", "z > 0"}), "(x > 0 || y > 0) && (z > 0)");
  try {
    all_of({"x > 0", "z > 0) || (z < 0"});
    ADD_FAILURE() << "each is a complete condition";
  } catch (const base::Error& e) {
    EXPECT_TRUE(test::mentions(e.what(), {"--select", "z > 0) || (z < 0", "6"}));
  }
}

}  // namespace
}  // namespace orrery::plot
