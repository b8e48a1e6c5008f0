// SPDX-License-Identifier: Apache-2.0
#include "scene/value_text.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <cstdlib>
#include <random>

namespace orrery::scene {
namespace {

TEST(SceneValueText, NumbersReadBackToTheSameBits) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 20000; ++i) {
    const double x = std::bit_cast<double>(random());
    if (x != x) continue;
    EXPECT_EQ(std::bit_cast<std::uint64_t>(std::strtod(number_text(x).c_str(), nullptr)),
              std::bit_cast<std::uint64_t>(x))
        << number_text(x);
  }
}

TEST(SceneValueText, NumbersAreShort) {
  EXPECT_EQ(number_text(0.1), "0.1");
  EXPECT_EQ(number_text(-1000), "-1000");
  EXPECT_EQ(number_text(1e18), "1e+18");
}

TEST(SceneValueText, LargeNumbersUseScientificNotation) {
  EXPECT_EQ(number_text(114588650129310105600.0), "1.145886501293101e+20");
  EXPECT_EQ(number_text(123456789012345.0), "123456789012345");
}

TEST(SceneValueText, MinusZeroKeepsItsSign) {
  EXPECT_EQ(number_text(-0.0), "-0.0");
  EXPECT_EQ(number_text(0.0), "0");
}

TEST(SceneValueText, VectorsAreLists) { EXPECT_EQ(vector_text({0, 1.5, -2}), "[0, 1.5, -2]"); }

TEST(SceneValueText, StringsAreEscaped) {
  EXPECT_EQ(string_text("a\"b\\c\n\x7f"), "\"a\\\"b\\\\c\\u000a\\u007f\"");
  EXPECT_EQ(string_text("\xC3\xBC"), "\"\xC3\xBC\"");
}

TEST(SceneValueText, UnquotedRemovesTheQuotes) {
  EXPECT_EQ(unquoted("\"exact\""), "exact");
  EXPECT_EQ(unquoted("7"), "7");
}

}  // namespace
}  // namespace orrery::scene
