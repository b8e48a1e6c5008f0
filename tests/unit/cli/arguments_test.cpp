// SPDX-License-Identifier: Apache-2.0
#include "cli/arguments.h"
#include "support/mentions.h"

#include <gtest/gtest.h>

namespace orrery::cli {
namespace {

/// The message of a check; empty: the value is valid.
std::string verdict(const Check& check, std::string value) { return check(value); }

TEST(CliArguments, OneOfSuggestsTheClosestName) {
  const Check check = one_of({"half", "float"});
  EXPECT_EQ(verdict(check, "float"), "");
  EXPECT_TRUE(test::mentions(verdict(check, "flaot"), {"`flaot`", "`float`"}));
  EXPECT_TRUE(test::mentions(verdict(check, "integer"), {"`integer`", "half", "float"}));
}

TEST(CliArguments, OneOfSuggestsNoNumbers) {
  EXPECT_TRUE(test::mentions(verdict(one_of({"8", "16"}), "12"), {"`12`", "8", "16"}));
}

TEST(CliArguments, WholeNumbersHaveLimitsAndNoTrailingText) {
  const Check check = whole_number(1, 20);
  EXPECT_EQ(verdict(check, "1"), "");
  EXPECT_EQ(verdict(check, "20"), "");
  for (const char* wrong : {"0", "21", "-1", "1.5", "3x", "", " 3", "99999999999999999999999"})
    EXPECT_EQ(verdict(check, wrong), std::string("must be an integer from 1 to 20, not `") + wrong + "`");
}

TEST(CliArguments, WholeNumbersAreDecimal) {
  std::string value = "010";
  EXPECT_EQ(whole_number(1, 20)(value), "");
  EXPECT_EQ(value, "10");
}

TEST(CliArguments, RealNumbersAreFinite) {
  const Check check = real_number(-100, 100);
  for (const char* right : {"0", "-100", "+1.5", "1e2", ".5"}) EXPECT_EQ(verdict(check, right), "") << right;
  for (const char* wrong : {"nan", "inf", "100.1", "abc", "", "+", "+-1", "1,5"})
    EXPECT_EQ(verdict(check, wrong), std::string("must be a number from -100 to 100, not `") + wrong + "`");
}

TEST(CliArguments, SizesAreBytesWithAUnit) {
  for (const auto& [text, bytes] :
       {std::pair{"1K", "1024"}, {"512M", "536870912"}, {"1.5G", "1610612736"}, {"2T", "2199023255552"}}) {
    std::string value = text;
    EXPECT_EQ(byte_size()(value), "");
    EXPECT_EQ(value, bytes);
  }
  for (const char* wrong : {"", "G", "8", "8g", "-1G", "0G", "nanG", "1e300T", "8GB"})
    EXPECT_TRUE(test::mentions(verdict(byte_size(), wrong), {"512M", std::string("`") + wrong + "`"}));
}

TEST(CliArguments, TimesAreSecondsWithUnits) {
  for (const auto& [text, seconds] : {std::pair{"90s", "90"},
                                      {"5m", "300"},
                                      {"1.5h", "5400"},
                                      {"1h30m", "5400"},
                                      {"1h30m5.5s", "5405.5"},
                                      {"0.01s", "0.01"},
                                      {"1h5s", "3605"}}) {
    std::string value = text;
    EXPECT_EQ(duration()(value), "") << text;
    EXPECT_EQ(value, seconds) << text;
  }
  EXPECT_TRUE(test::mentions(verdict(duration(), "0s"), {"0.01s", "`0s`"}));
  EXPECT_TRUE(test::mentions(verdict(duration(), "8761h"), {"8760h", "`8761h`"}));
  for (const char* wrong : {"", "3", "1h30", "s", "-5s", "5d", "5s5", "1m1h", "5m5m", "1..5s", "5ms", "nans", "1e3s"})
    EXPECT_TRUE(test::mentions(verdict(duration(), wrong), {"1h30m", std::string("`") + wrong + "`"}));
}

}  // namespace
}  // namespace orrery::cli
