// SPDX-License-Identifier: Apache-2.0
#include "cli/progress_text.h"

#include <gtest/gtest.h>

namespace orrery::cli {
namespace {

TEST(CliProgressText, EveryNameSelectsItsStyle) {
  const auto& names = progress_style_names();
  ASSERT_EQ(names.size(), 7u);
  EXPECT_EQ(progress_style("auto"), ProgressStyle::kAuto);
  EXPECT_EQ(progress_style("bar"), ProgressStyle::kBar);
  EXPECT_EQ(progress_style("alf"), ProgressStyle::kAlf);
  EXPECT_EQ(progress_style("openjd"), ProgressStyle::kOpenJd);
  EXPECT_EQ(progress_style("arnold"), ProgressStyle::kArnold);
  EXPECT_EQ(progress_style("json"), ProgressStyle::kJson);
  EXPECT_EQ(progress_style("none"), ProgressStyle::kNone);
}

TEST(CliProgressText, LinesHaveTheFormatsOfSupervisors) {
  const ProgressState state{42, 100, 10};
  EXPECT_EQ(progress_line(ProgressStyle::kAlf, state), "ALF_PROGRESS 42%");
  EXPECT_EQ(progress_line(ProgressStyle::kOpenJd, state), "openjd_progress: 42");
  EXPECT_EQ(progress_line(ProgressStyle::kArnold, state), "42% done");
}

TEST(CliProgressText, JsonHasTheRateOnceItIsKnown) {
  EXPECT_EQ(progress_line(ProgressStyle::kJson, {42, 100, 10}),
            R"({"progress": 42, "samples_done": 42, "samples_total": 100, "seconds": 10.0, "samples_per_second": 4, )"
            R"("seconds_left": 13.8})");
  EXPECT_EQ(progress_line(ProgressStyle::kJson, {0, 100, 0}),
            R"({"progress": 0, "samples_done": 0, "samples_total": 100, "seconds": 0.0})");
}

TEST(CliProgressText, OnlyAFinishedRenderIsAtAHundredPercent) {
  EXPECT_EQ((ProgressState{0, 1000, 1}.percent()), 0);
  EXPECT_EQ((ProgressState{9, 1000, 1}.percent()), 0);
  EXPECT_EQ((ProgressState{999, 1000, 1}.percent()), 99);
  EXPECT_EQ((ProgressState{1000, 1000, 1}.percent()), 100);
  // The quotient rounds to 1.
  constexpr std::uint64_t kMany = 1ull << 60;
  EXPECT_EQ((ProgressState{kMany - 1, kMany, 1}.percent()), 99);
  EXPECT_EQ((ProgressState{0, 0, 0}.percent()), 100);
}

TEST(CliProgressText, TimeLeftFollowsTheMeanRate) {
  EXPECT_DOUBLE_EQ((ProgressState{25, 100, 10}.seconds_left()), 30);
  EXPECT_DOUBLE_EQ((ProgressState{100, 100, 10}.seconds_left()), 0);
  EXPECT_LT((ProgressState{0, 100, 10}.seconds_left()), 0);
}

TEST(CliProgressText, BarFillsWithTheFraction) {
  EXPECT_EQ(progress_bar({50, 100, 1e-5}, 80),
            "[####################....................]  50 %  5.0 M samples/s  0:01 left");
  EXPECT_EQ(progress_bar({100, 100, 1}, 80),
            "[########################################] 100 %  100 samples/s  0:00 left");
}

TEST(CliProgressText, BarOmitsAnUnknownTime) {
  EXPECT_EQ(progress_bar({0, 100, 0}, 50), "[............................]   0 %  0 samples/s");
}

TEST(CliProgressText, BarFitsIntoAnyTerminal) {
  const ProgressState state{1'500'000, 3'000'000, 5000};
  for (int columns = 1; columns <= 120; ++columns)
    EXPECT_LT(progress_bar(state, columns).size(), static_cast<std::size_t>(columns)) << columns;
  EXPECT_EQ(progress_bar(state, 40), " 50 %  300 samples/s  1:23:20 left");
  EXPECT_EQ(progress_bar(state, 11), " 50 %  300");
}

TEST(CliProgressText, RatesHaveTheLargestUnitAboveOne) {
  const auto has = [](std::uint64_t done, const char* rate) {
    return progress_bar({done, 2 * done, 1}, 80).find(rate) != std::string::npos;
  };
  EXPECT_TRUE(has(999, "  999 samples/s"));
  EXPECT_TRUE(has(1500, "  1.5 k samples/s"));
  EXPECT_TRUE(has(2'340'000, "  2.3 M samples/s"));
}

}  // namespace
}  // namespace orrery::cli
