// SPDX-License-Identifier: Apache-2.0
#include "base/file_name.h"

#include <gtest/gtest.h>

namespace orrery::base {
namespace {

TEST(BaseFileName, ACompanionHasStemAndSuffix) {
  EXPECT_EQ(companion_name("shot.0007", ".checkpoint.exr"), "shot.0007.checkpoint.exr");
  const std::string fits(kLongestFileName - 4, 'a');
  EXPECT_EQ(companion_name(fits, ".ply"), fits + ".ply");
}

TEST(BaseFileName, ACompanionOfALongNameFitsAndStaysUnique) {
  const std::string stem(251, 'a');
  const std::string name = companion_name(stem, ".checkpoint.exr");
  EXPECT_EQ(name.size(), kLongestFileName);
  EXPECT_NE(name, companion_name(stem.substr(1) + 'b', ".checkpoint.exr"));
  EXPECT_EQ(name.substr(name.size() - 15), ".checkpoint.exr");
}

TEST(BaseFileName, CharactersAreNotSplit) {
  std::string stem = "x";  // so that no even length ends at the end of a character
  while (stem.size() < 250) stem += "ä";
  EXPECT_EQ(utf8_prefix(stem, 4), "xä");
  EXPECT_EQ(utf8_prefix(stem, 5), "xää");
  EXPECT_EQ(utf8_prefix("ab", 5), "ab");
  EXPECT_EQ(utf8_prefix("ää", 1), "");
  const std::string name = companion_name(stem, ".checkpoint.exr");
  EXPECT_LE(name.size(), kLongestFileName);
  EXPECT_EQ(utf8_prefix(stem, name.size() - 32), std::string_view(name).substr(0, name.size() - 32));
}

}  // namespace
}  // namespace orrery::base
