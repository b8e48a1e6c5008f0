// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <functional>
#include <thread>
#include <vector>

#include "cli/program.h"

namespace orrery::test {
namespace {

class CliSignals : public ProgramTest {
 protected:
  /// Starts the program in the background, whatever this test's own parent ignores.
  pid_t start(std::vector<const char*> words, int ignored = 0) {
    words.insert(words.begin(), "orrery");
    words.push_back(nullptr);
    std::filesystem::remove(folder_ / ".err");
    const pid_t child = fork();
    if (child != 0) return child;
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) signal(number, number == ignored ? SIG_IGN : SIG_DFL);
    if (chdir(folder_.c_str()) != 0) _exit(126);
    const int out = open(".err", O_WRONLY | O_CREAT | O_TRUNC, 0600);
    dup2(out, 2);
    execv(ORRERY_PROGRAM, const_cast<char* const*>(words.data()));
    _exit(127);
  }
  /// A render that would take hours. It listens to signals once it has told how far it is.
  pid_t start_render(int ignored = 0) {
    const pid_t child = start({"render", "good.toml", "-o", "a.exr", "--width", "1000", "--height", "1000", "--samples",
                               "60000", "--progress", "arnold"},
                              ignored);
    wait_until([&] { return text_of(folder_ / ".err").find("done") != std::string::npos; });
    return child;
  }
  static void wait_until(const std::function<bool()>& true_at_last) {
    for (int i = 0; i < 1200 && !true_at_last(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(25));
  }
  static int wait_for(pid_t child) {
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
};

TEST_F(CliSignals, TermAndIntStopSoonAndLeaveACheckpoint) {
  for (const int number : {SIGTERM, SIGINT, SIGHUP}) {
    const pid_t child = start_render();
    kill(child, number);
    EXPECT_EQ(wait_for(child), 75) << number;
    EXPECT_EQ(file_count(), 1);
    EXPECT_TRUE(std::filesystem::remove(folder_ / "a.checkpoint.exr"));
    EXPECT_NE(text_of(folder_ / ".err").find("no picture was written; a.checkpoint.exr"), std::string::npos);
  }
}

TEST_F(CliSignals, ASecondOneEndsAtOnce) {
  const pid_t child = start_render();
  kill(child, SIGINT);
  kill(child, SIGTERM);  // two kinds, so that the kernel does not make them one
  const int status = wait_for(child);
  EXPECT_TRUE(status == 75 || status == 128 + SIGINT || status == 128 + SIGTERM) << status;
  EXPECT_EQ(file_count(), status == 75 ? 1 : 0);
}

TEST_F(CliSignals, Usr1WritesASnapshotAndGoesOn) {
  const pid_t child = start_render();
  kill(child, SIGUSR1);
  wait_until([&] { return text_of(folder_ / ".err").find("wrote a.checkpoint.exr") != std::string::npos; });
  EXPECT_TRUE(std::filesystem::exists(folder_ / "a.checkpoint.exr"));
  EXPECT_EQ(waitpid(child, nullptr, WNOHANG), 0);
  kill(child, SIGKILL);
  wait_for(child);
}

TEST_F(CliSignals, WhatWasIgnoredStaysSo) {
  // As under nohup: the render goes on, until a signal comes that it listens to.
  const pid_t child = start_render(SIGHUP);
  kill(child, SIGHUP);
  kill(child, SIGHUP);
  EXPECT_EQ(waitpid(child, nullptr, WNOHANG), 0);
  kill(child, SIGTERM);
  EXPECT_EQ(wait_for(child), 75);
}

TEST_F(CliSignals, GeneratingEndsAtTheFirstOneAndLeavesNothing) {
  // The points file comes under a temporary name first, and would grow to 3.6 GB.
  const pid_t child = start({"generate", "cloud", "-o", "cloud.toml", "--count", "5000000"});
  wait_until([&] { return file_count() > 0; });
  EXPECT_GT(file_count(), 0);
  kill(child, SIGINT);
  EXPECT_EQ(wait_for(child), 128 + SIGINT);
  EXPECT_EQ(file_count(), 0);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "cloud.toml"));
}

}  // namespace
}  // namespace orrery::test
