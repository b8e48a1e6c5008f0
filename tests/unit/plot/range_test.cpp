// SPDX-License-Identifier: Apache-2.0
#include "plot/range.h"

#include <gtest/gtest.h>

#include <string>

#include "base/error.h"

namespace orrery::plot {
namespace {

/// The range of the integers 0 to 1000, shuffled: "10 990".
std::string range_of(const std::string& text, int offset = 0) {
  RangeFinder finder(parse_range(text));
  for (int i = 0; i <= 1000; ++i) finder.add(i * 8 % 1001 + offset);
  const scene::Interval range = finder.range();
  return std::to_string(static_cast<int>(range.low)) + " " + std::to_string(static_cast<int>(range.high));
}

std::string error_of(const std::string& text) {
  try {
    parse_range(text);
  } catch (const base::Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(PlotRange, NumbersAreFixed) {
  const RangeChoice range = parse_range("-1e3:2.5");
  ASSERT_TRUE(range.fixed());
  EXPECT_EQ(range.fixed()->low, -1000);
  EXPECT_EQ(range.fixed()->high, 2.5);
  EXPECT_EQ(parse_range("symmetric,-1:3").fixed()->low, -3);
  EXPECT_FALSE(parse_range("0:99%").fixed());
  EXPECT_FALSE(parse_range("log").fixed());
  EXPECT_TRUE(parse_range("log").is_log);
}

TEST(PlotRange, PercentilesAreThoseOfAllValues) {
  EXPECT_EQ(range_of("1%:99%"), "10 990");
  EXPECT_EQ(range_of("log"), "0 1000");
  EXPECT_EQ(range_of("log,5%:50%"), "50 500");
  EXPECT_EQ(range_of("20:99%"), "20 990");
  EXPECT_EQ(range_of("symmetric", -300), "-700 700");
  EXPECT_EQ(range_of("symmetric,10%:50%", -300), "-200 200");
  EXPECT_THROW(range_of("2000:100%"), base::Error);
}

TEST(PlotRange, ManyValuesAreSampled) {
  RangeFinder finder(parse_range("25%:75%"));
  constexpr int kCount = 40'000'000;
  for (int i = 0; i < kCount; ++i) finder.add(i);
  EXPECT_NEAR(finder.range().low, 0.25 * kCount, 8);
  EXPECT_NEAR(finder.range().high, 0.75 * kCount, 8);
}

TEST(PlotRange, FewValuesThatUseUpTheMapAreFound) {
  const auto crowded = [](const std::string& range, int outliers, double at) {
    RangeFinder finder(range.empty() ? RangeChoice() : parse_range(range));
    for (int i = 0; i < 1000; ++i) finder.add(i < outliers ? at + i : i % 10);
    return finder.crowded();
  };
  ASSERT_TRUE(crowded("", 5, 200));
  EXPECT_EQ(crowded("", 5, 200)->low, 0);
  EXPECT_EQ(crowded("", 5, 200)->high, 9);
  EXPECT_TRUE(crowded("", 5, -200)) << "at the lower end";
  EXPECT_FALSE(crowded("", 15, 200)) << "not so few";
  EXPECT_FALSE(crowded("", 5, 20)) << "not so far";
  EXPECT_FALSE(crowded("", 0, 0));
  for (const char* range : {"1%:99%", "0:9", "log"}) EXPECT_FALSE(crowded(range, 5, 200)) << range;
  RangeFinder constant{RangeChoice()};
  for (int i = 0; i < 1000; ++i) constant.add(3);
  EXPECT_FALSE(constant.crowded());
}

TEST(PlotRange, InvalidRangesAreRefused) {
  for (const char* text : {"", "5", "1:", ":1", "1:x", "1:2:3", "lin", "log,", "nan:1", "1%:inf"})
    EXPECT_NE(error_of(text).find("is not a range; write LOW:HIGH"), std::string::npos) << text;
  EXPECT_NE(error_of("1:1").find("less than the second"), std::string::npos);
  EXPECT_NE(error_of("99%:1%").find("less than the second"), std::string::npos);
  EXPECT_NE(error_of("1%:101%").find("percentiles are from 0% to 100%"), std::string::npos);
  EXPECT_NE(error_of("-1e301:0").find("from -1e+300 to 1e+300"), std::string::npos);
  EXPECT_NE(error_of("log,0:1").find("must be above 0 with log"), std::string::npos);
  EXPECT_NE(error_of("log,symmetric").find("log excludes symmetric"), std::string::npos);
}

}  // namespace
}  // namespace orrery::plot
