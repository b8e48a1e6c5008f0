// SPDX-License-Identifier: Apache-2.0
#include "base/frames.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "support/mentions.h"
#include "support/temp_dir.h"

namespace orrery::base {
namespace {

using Frames = std::vector<int>;

TEST(BaseFrames, ParsesRangesStepsAndLists) {
  EXPECT_EQ(parse_frames("7"), (Frames{7}));
  EXPECT_EQ(parse_frames("1-4"), (Frames{1, 2, 3, 4}));
  EXPECT_EQ(parse_frames("1-10:3"), (Frames{1, 4, 7, 10}));
  EXPECT_EQ(parse_frames("1-10x4"), (Frames{1, 5, 9}));
  EXPECT_EQ(parse_frames("1,3,7-9"), (Frames{1, 3, 7, 8, 9}));
  EXPECT_EQ(parse_frames("9-7,8,1"), (Frames{9, 8, 7, 1}));
  EXPECT_EQ(parse_frames("-2--1,-1-1"), (Frames{-2, -1, 0, 1}));
}

TEST(BaseFrames, InvalidRangesAreRefused) {
  for (const char* text :
       {"", "a", "1-", "-", "1-2-3", "1,", ",1", "1-5x", "1-5x0", "1-5x-1", "1 2", "99999999", "1-9999999"}) {
    try {
      parse_frames(text);
      ADD_FAILURE() << text;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kUsage) << text;
    }
  }
}

TEST(BaseFrames, TooManyFramesAreRefused) {
  const auto told = [](const std::string& text) -> std::string {
    try {
      return std::to_string(parse_frames(text).size()) + " frames";
    } catch (const Error& error) {
      return error.what();
    }
  };
  const std::string forms = "; write 1-10, 1-10x2 or 1,3,7-9";
  EXPECT_EQ(told("1-100000"), "100000 frames");
  EXPECT_EQ(told("1-9999999x100"), "100000 frames");
  EXPECT_TRUE(test::mentions(told("1-100001"), {"`1-100001`", "100000 frames", forms}));
  EXPECT_TRUE(test::mentions(told("1-60000,70001-120000"), {"`1-60000,70001-120000`", "100000 frames", forms}));
  EXPECT_TRUE(test::mentions(told("1-1000000000"), {"`1-1000000000`", "1000000000", "9999999", forms}));
  EXPECT_TRUE(test::mentions(told("1-99999999999999999999"), {"`1-99999999999999999999`", "9999999", forms}));
  EXPECT_TRUE(test::mentions(told("1-"), {"`1-`", "end", "missing", forms}));
}

TEST(BaseFrames, FormatsShortRanges) {
  EXPECT_EQ(frames_text({}), "");
  EXPECT_EQ(frames_text({7}), "7");
  EXPECT_EQ(frames_text({1, 2, 3, 5, 8, 9}), "1-3,5,8-9");
  EXPECT_EQ(parse_frames(frames_text({-2, -1, 4})), (Frames{-2, -1, 4}));
}

TEST(BaseFrames, ReplacesPatterns) {
  EXPECT_EQ(with_frame("shot.####.exr", 7), "shot.0007.exr");
  EXPECT_EQ(with_frame("shot.####.exr", 12345), "shot.12345.exr");
  EXPECT_EQ(with_frame("a/%04d/b.%d.exr", 12), "a/%04d/b.12.exr") << "not in folders";
  EXPECT_EQ(with_frame("##", -3), "-3");
  EXPECT_EQ(with_frame("####", -3), "-003");
  EXPECT_EQ(with_frame("take#1.exr", 5), "take#1.exr");
  EXPECT_EQ(with_frame("100%.exr", 5), "100%.exr");
  EXPECT_FALSE(has_frame_pattern("run##2/a.png"));
  EXPECT_TRUE(has_frame_pattern("a.##.png"));
  EXPECT_TRUE(has_frame_pattern("a.%02d.png"));
  EXPECT_FALSE(has_frame_pattern("a#.png"));
  EXPECT_FALSE(has_frame_pattern("a%s.png"));
  EXPECT_FALSE(has_frame_pattern("%999999999999999999999d"));
}

TEST(BaseFrames, InputsThatExistUnderTheirNameAreNoSequence) {
  const support::TempDir folder;
  support::write_bytes(folder / "20%density.ply", "");
  EXPECT_FALSE(is_sequence(folder / "20%density.ply"));
  EXPECT_TRUE(is_sequence(folder / "30%density.ply"));
  EXPECT_EQ(input_at_frame(folder.path(), "20%density.ply", 1), "20%density.ply");
  EXPECT_EQ(input_at_frame(folder.path(), "30%density.ply", 1), "301ensity.ply");
}

}  // namespace
}  // namespace orrery::base
