// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <filesystem>

#include "base/error.h"
#include "points_file.h"

namespace orrery::points {
namespace {

using Numbers = std::vector<double>;
using PointsOpenData = PointsFile;

TEST_F(PointsOpenData, AFileStaysOpenForItsOtherFrames) {
  const std::string head = "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS pp pp pp\n0 9\n0 9\n0 9\n";
  const std::string first = head + "ITEM: ATOMS x y z radius\n1 0 0 1\n",
                    second = head + "ITEM: ATOMS x y z radius\n2 0 0 1\n";
  request.open = open_once();
  request.frame = 2;
  EXPECT_EQ(load("a.dump", first + second), "");
  EXPECT_EQ(x(), Numbers{2});
  // What was read is not read again: a file of the same size and time is the same file.
  const auto time = std::filesystem::last_write_time(request.file);
  std::string other = first;
  other[0] = '#';
  write("a.dump", other + second);
  std::filesystem::last_write_time(request.file, time);
  EXPECT_EQ(load(), "");
  EXPECT_EQ(x(), Numbers{2});
  request.open = {};
  EXPECT_THROW(load(), base::Error) << "the first frame is damaged";
}

TEST_F(PointsOpenData, AFileThatHasChangedIsOpenedAgain) {
  request.open = open_once();
  EXPECT_EQ(load("a.csv", "x,y,z,radius\n1,0,0,1\n"), "");
  EXPECT_EQ(load("a.csv", "x,y,z,radius\n12,0,0,1\n"), "");
  EXPECT_EQ(x(), Numbers{12});
}

}  // namespace
}  // namespace orrery::points
