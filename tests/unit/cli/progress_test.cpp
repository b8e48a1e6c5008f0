// SPDX-License-Identifier: Apache-2.0
#include "cli/progress.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <cstdio>
#include <string>

namespace orrery::cli {
namespace {

using namespace std::chrono_literals;

/// Longer than any test.
constexpr std::chrono::milliseconds kNever = 24h;

class CliProgress : public testing::Test {
 protected:
  ~CliProgress() override { std::fclose(file_); }

  std::string printed() {
    std::fflush(file_);
    std::rewind(file_);
    std::string text;
    for (int c = std::fgetc(file_); c != EOF; c = std::fgetc(file_)) text += static_cast<char>(c);
    return text;
  }

  std::FILE* file_ = std::tmpfile();
};

TEST_F(CliProgress, PrintsALineAtEachWholePercent) {
  {
    ProgressPrinter printer(ProgressStyle::kArnold, file_, kNever);
    for (const std::uint64_t done : {0, 4, 9, 10, 11, 500, 505, 999, 1000, 1000}) printer.update({done, 1000, 1});
  }
  EXPECT_EQ(printed(), "0% done\n1% done\n50% done\n99% done\n100% done\n");
}

TEST_F(CliProgress, AutoPrintsALineAtEachTenthWithoutATerminal) {
  {
    ProgressPrinter printer(ProgressStyle::kAuto, file_, kNever);
    for (std::uint64_t done = 0; done <= 1000; ++done) printer.update({done, 1000, 1});
  }
  std::string lines;
  for (int percent = 10; percent <= 100; percent += 10) lines += std::to_string(percent) + "% done\n";
  EXPECT_EQ(printed(), lines);
}

TEST_F(CliProgress, PreparationIsShownInPlaceOfTheBar) {
  {
    ProgressPrinter printer(ProgressStyle::kBar, file_, kNever);
    printer.prepare("reading", 0);
    for (const double fraction : {0.1, 0.102, 0.05, 0.5}) printer.prepare("building", fraction);
    printer.update({1, 2, 1});
    printer.prepare("building", 0.9);  // late, from another thread
  }
  const std::string text = printed();
  EXPECT_EQ(text.find("\rreading\033[K\rbuilding  10 %\033[K\rbuilding  50 %\033[K\r["), 0u) << text;
  EXPECT_EQ(text.find("90 %"), std::string::npos) << text;
}

TEST_F(CliProgress, PreparationAddsNoLines) {
  { ProgressPrinter(ProgressStyle::kArnold, file_, kNever).prepare("building", 0.5); }
  EXPECT_EQ(printed(), "");
}

TEST_F(CliProgress, NonePrintsNothing) {
  { ProgressPrinter(ProgressStyle::kNone, file_, 1ms).update({42, 100, 1}); }
  EXPECT_EQ(printed(), "");
}

TEST_F(CliProgress, FinishClearsTheBar) {
  {
    ProgressPrinter printer(ProgressStyle::kBar, file_, kNever);
    printer.update({1, 4, 1});
    printer.update({2, 4, 1});
  }
  const std::string text = printed();
  EXPECT_EQ(text.find('\n'), std::string::npos);
  EXPECT_NE(text.find("\r[##########"), std::string::npos);
  EXPECT_NE(text.find(" 50 %"), std::string::npos);
  EXPECT_TRUE(text.ends_with("\r\033[K")) << text;
}

TEST_F(CliProgress, NothingIsPrintedAfterTheEnd) {
  ProgressPrinter printer(ProgressStyle::kArnold, file_, kNever);
  printer.update({1, 2, 1});
  printer.finish();
  printer.update({2, 2, 1});
  EXPECT_EQ(printed(), "50% done\n");
}

/// Waits until the file contains a text. Expects some heartbeats, not a number of them, which depends on the machine.
void wait_for(std::FILE* file, const std::string& wanted) {
  std::string text;
  while (text.find(wanted) == std::string::npos) {
    std::this_thread::sleep_for(5ms);
    char buffer[4096];
    const auto length = ::pread(fileno(file), buffer, sizeof(buffer), 0);
    text.assign(buffer, static_cast<std::size_t>(length));
  }
}

TEST_F(CliProgress, HeartbeatRepeatsTheLastLine) {
  ProgressPrinter printer(ProgressStyle::kOpenJd, file_, 2ms);
  printer.update({42, 100, 1});
  wait_for(file_, "openjd_progress: 42\nopenjd_progress: 42\nopenjd_progress: 42\n");
}

TEST_F(CliProgress, HeartbeatsNameThePhase) {
  ProgressPrinter printer(ProgressStyle::kArnold, file_, 2ms);
  printer.prepare("building", 0.5);
  wait_for(file_, "0% done, building  50 %\n");
}

TEST_F(CliProgress, HeartbeatStartsBeforeTheFirstSample) {
  const ProgressPrinter printer(ProgressStyle::kAlf, file_, 2ms);
  char buffer[64] = {};
  while (::pread(fileno(file_), buffer, sizeof(buffer) - 1, 0) == 0) std::this_thread::sleep_for(5ms);
  EXPECT_EQ(std::string(buffer).substr(0, 16), "ALF_PROGRESS 0%\n");
}

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
  ProgressState building{0, 100, 0};
  building.phase = "building";
  building.prepared = 0.5;
  EXPECT_EQ(progress_line(ProgressStyle::kJson, building),
            R"({"progress": 0, "samples_done": 0, "samples_total": 100, "seconds": 0.0, "phase": "building", )"
            R"("phase_progress": 50})");
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

TEST(CliProgressText, BarOmitsAnUnknownRateAndTime) {
  EXPECT_EQ(progress_bar({0, 100, 0}, 50), "[........................................]   0 %");
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
