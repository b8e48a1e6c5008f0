// SPDX-License-Identifier: Apache-2.0
#include "data/frames.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "data/data_file.h"
#include "support/data_tables.h"

namespace orrery::data {
namespace {

/// XYZ files, which are TextFrames.
class DataFrames : public testing::Test {
 protected:
  std::unique_ptr<DataFile> open(const std::string& text, OpenOptions options = {}) {
    support::write_bytes(folder_ / "a.xyz", text);
    return data::open(folder_ / "a.xyz", options);
  }
  support::TempDir folder_;
};

std::string frame(int x) { return "1\ncomment\nC " + std::to_string(x) + " 0 0\n"; }

double x_of(DataFile& file, int number) { return support::numbers(file.read(number, {"x"}), "x").at(0); }

TEST_F(DataFrames, AreLocatedOnDemandInAnyOrder) {
  const auto file = open(frame(1) + frame(2) + "\n" + frame(3) + "\n\n");
  EXPECT_EQ(x_of(*file, 1), 2);
  EXPECT_EQ(x_of(*file, 0), 1);
  EXPECT_TRUE(file->has_frame(2));
  EXPECT_FALSE(file->has_frame(3));
  EXPECT_EQ(x_of(*file, 2), 3);
  EXPECT_EQ(file->frame_count(), 3);
}

TEST_F(DataFrames, AMalformedFrameLeavesThoseBeforeItUsable) {
  const auto file = open(frame(1) + frame(2) + "2\ncomment\nC 0 0 0\n");
  EXPECT_EQ(x_of(*file, 1), 2);
  EXPECT_THROW(file->read(2, {"x"}), base::Error);
  EXPECT_EQ(x_of(*file, 0), 1);
}

TEST_F(DataFrames, MoreRowsThanDeclaredAreAnErrorWithTheirLine) {
  const auto file = open(frame(1) + "C 9 9 9\n");
  try {
    file->read(0, {"x"});
    FAIL() << "no error";
  } catch (const base::Error& error) {
    EXPECT_EQ(error.kind(), base::ErrorKind::kBadData);
    EXPECT_EQ(error.diagnostics().at(0).line, 4);
  }
}

TEST_F(DataFrames, TheirTableFitsIntoMemory) {
  std::string text;
  for (int i = 0; i < 5000; ++i) text += frame(i);
  OpenOptions options;
  options.memory_limit = text.size() + 50'000;
  const auto file = open(text, options);
  try {
    file->frame_count();
    FAIL() << "no error";
  } catch (const base::Error& error) {
    EXPECT_EQ(error.kind(), base::ErrorKind::kNoMemory);
  }
}

}  // namespace
}  // namespace orrery::data
