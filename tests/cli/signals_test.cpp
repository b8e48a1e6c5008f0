// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <vector>

#include "cli/program.h"
#include "support/paced_program.h"

namespace orrery::test {
namespace {

class CliSignals : public ProgramTest {
 protected:
  /// Starts a render that would take hours. It installs its signal handlers before it reports progress.
  PacedProgram start_render(int ignored_signal = 0) const {
    return PacedProgram(folder_,
                        {"render", "good.toml", "-o", "a.exr", "--width", "1000", "--height", "1000", "--samples",
                         "60000", "--progress", "arnold", "-t", "1"},
                        {RLIM_INFINITY, ignored_signal});
  }
};

TEST_F(CliSignals, TermIntAndHupStopTheRenderAndLeaveACheckpoint) {
  for (const int number : {SIGTERM, SIGINT, SIGHUP}) {
    PacedProgram render = start_render();
    ASSERT_TRUE(render.run_to(0)) << render.text();
    render.send(number);
    EXPECT_EQ(render.wait(), 75) << number;
    EXPECT_EQ(file_count(), 1);
    EXPECT_TRUE(std::filesystem::remove(folder_ / "a.checkpoint.exr"));
    EXPECT_NE(render.text().find("no image was written; a.checkpoint.exr"), std::string::npos) << render.text();
  }
}

TEST_F(CliSignals, SecondSignalExitsAtOnce) {
  PacedProgram render = start_render();
  ASSERT_TRUE(render.run_to(0)) << render.text();
  render.send(SIGINT);
  render.send(SIGTERM);  // a different signal, because pending signals of one kind are merged
  const int status = render.wait();
  EXPECT_TRUE(status == 75 || status == 128 + SIGINT || status == 128 + SIGTERM) << status;
  EXPECT_EQ(file_count(), status == 75 ? 1 : 0);
}

TEST_F(CliSignals, Usr1WritesACheckpointAndContinues) {
  PacedProgram render = start_render();
  ASSERT_TRUE(render.run_to(0)) << render.text();
  render.send(SIGUSR1);
  EXPECT_TRUE(render.run_until("wrote a.checkpoint.exr")) << render.text();
  EXPECT_TRUE(std::filesystem::exists(folder_ / "a.checkpoint.exr"));
  EXPECT_TRUE(render.is_running());
}

TEST_F(CliSignals, IgnoredSignalsStayIgnored) {
  // As under nohup: the render continues until a signal that it handles.
  PacedProgram render = start_render(SIGHUP);
  ASSERT_TRUE(render.run_to(0)) << render.text();
  render.send(SIGHUP);
  render.send(SIGHUP);
  EXPECT_TRUE(render.is_running());
  render.send(SIGTERM);
  EXPECT_EQ(render.wait(), 75);
}

/// The signal comes while the data are read, or while a render that would take hours begins.
TEST_F(CliSignals, PlotStopsWhileItPrepares) {
  std::string rows = "x,y,z\n";
  for (int i = 0; i < 1'000'000; ++i) rows += std::to_string(i % 1000) + "," + std::to_string(i / 1000) + ",0\n";
  write("a.csv", rows);
  for (const int number : {SIGTERM, SIGINT}) {
    PacedProgram plot(folder_, {"plot",    "a.csv",     "-o",       "a.exr",      "--width",    "1000", "--height",
                                "1000",    "--samples", "60000",    "--progress", "arnold",     "-t",   "1",
                                "--stats", "a.json",    "--legend", "l.svg",      "--color-by", "x"});
    ASSERT_TRUE(plot.run_changes(1)) << plot.text();  // the check that files can be created comes before the data
    plot.send(number);
    EXPECT_EQ(plot.wait(), 75) << plot.text();
    EXPECT_NE(plot.text().find("orrery: stopped"), std::string::npos) << plot.text();
    EXPECT_NE(text_of(folder_ / "a.json").find("\"stopped\""), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "a.exr"));
    std::filesystem::remove(folder_ / "a.json");
  }
}

TEST_F(CliSignals, GenerateExitsAtTheFirstSignalAndLeavesNoFiles) {
  // The points file is first written under a temporary name. If the program was faster than the test, the signal came
  // too late; it is then given more work.
  for (int count = 5'000'000; count <= 320'000'000; count *= 4) {
    const std::string spheres = std::to_string(count);
    PacedProgram generate(folder_, {"generate", "cloud", "-o", "cloud.toml", "--count", spheres.c_str()});
    // The first changes may come from the check that files can be created; wait for data.
    const auto has_data = [&] {
      for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
        std::error_code gone;
        const auto size = entry.file_size(gone);
        if (!gone && size > 1'000'000) return true;
      }
      return false;
    };
    do generate.run_changes(1);
    while (!has_data() && generate.is_running());
    generate.send(SIGINT);
    const int status = generate.wait();
    const bool has_scene = std::filesystem::remove(folder_ / "cloud.toml");
    if (std::filesystem::remove(folder_ / "cloud.ply")) continue;  // it was complete when the signal came
    EXPECT_EQ(status, 128 + SIGINT) << generate.text();
    EXPECT_EQ(file_count(), 0);
    EXPECT_FALSE(has_scene);
    return;
  }
  FAIL() << "no signal arrived while the file was being written";
}

}  // namespace
}  // namespace orrery::test
