// SPDX-License-Identifier: Apache-2.0
// What remains after a render is killed, runs out of disk space, or loses its output folder. ORRERY_CRASHES sets the
// number of interruptions and of file size limits. A fixed seed selects them; nothing depends on the clock.
#include <cstdlib>
#include <random>
#include <thread>
#include <utility>
#include <vector>

#include "cli/program.h"
#include "support/paced_program.h"

namespace orrery::test {
namespace {

int tries() {
  const char* const text = std::getenv("ORRERY_CRASHES");
  return text != nullptr ? std::atoi(text) : 30;
}

class BatchCrash : public ProgramTest {
 protected:
  /// Renders the expected image and an older, different one.
  void SetUp() override {
    write("scene.toml", R"(
[image]
width = 160
height = 90
[render]
samples = 100
[output]
layers = ["Z"]
[material.grey]
type = "lambertian"
albedo = [0.5, 0.5, 0.5]
[[sphere]]
center = [0, 0, -1]
radius = 0.5
material = "grey"
[[sphere]]
center = [0, -100.5, -1]
radius = 100
material = "grey"
)");
    ASSERT_EQ(run("render scene.toml -o a.exr --reproducible -q").status, 0);
    right_ = text_of(folder_ / "a.exr");
    ASSERT_EQ(run("render scene.toml -o a.exr --reproducible -q --set render.seed=5 --samples 1").status, 0);
    old_ = text_of(folder_ / "a.exr");
    ASSERT_NE(right_, old_);
  }

  PacedProgram start(std::vector<const char*> words, rlim_t largest_file = RLIM_INFINITY) const {
    return PacedProgram(folder_, std::move(words), {largest_file, 0});
  }

  std::string picture() const { return text_of(folder_ / "a.exr"); }
  void put_old() const { support::write_bytes(folder_ / "a.exr", old_); }
  /// Removes temporary files of killed processes.
  void remove_leftovers() const {
    for (const auto& entry : std::filesystem::directory_iterator(folder_))
      if (entry.path().filename().string().rfind(".a.", 0) == 0) std::filesystem::remove(entry.path());
  }

  std::string right_, old_;
};

const std::vector<const char*> kRender = {"render", "scene.toml", "-o",     "a.exr",    "--reproducible", "-t",
                                          "1",      "--progress", "arnold", "--resume", "--checkpoint",   "0.01s"};

TEST_F(BatchCrash, KillAtAnyMomentLeavesTheOldOrTheNewImage) {
  std::mt19937 random(11);
  std::uniform_int_distribution<int> percent(0, 80), changes(1, 24);
  int interrupted = 0;
  for (int i = 0; i < tries(); ++i) {
    PacedProgram render = start(kRender);
    switch (i % 3) {
      case 0: render.run_to(percent(random)); break;       // during sampling: it cannot have finished
      case 1: render.run_changes(changes(random)); break;  // most likely while writing a checkpoint
      default:                                             // while writing the image
        render.run_to(100);
        render.run_changes(changes(random));
    }
    render.send(SIGKILL);
    const int status = render.wait();
    ASSERT_TRUE(status == 0 || status == 128 + SIGKILL) << status << "\n" << render.text();
    const std::string found = picture();
    ASSERT_TRUE(found == old_ || found == right_) << "killed in try " << i;
    interrupted += status != 0;
    if (found == right_) put_old();
    // The next try of the first kind starts anew; the others resume from the checkpoint, if any.
    if (i % 3 == 2) std::filesystem::remove(folder_ / "a.checkpoint.exr");
    remove_leftovers();
  }
  EXPECT_GE(interrupted, tries() / 3);
  // Whatever the last try left behind, the next render completes normally.
  ASSERT_EQ(start(kRender).wait(), 0);
  EXPECT_EQ(picture(), right_);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "a.checkpoint.exr"));
}

TEST_F(BatchCrash, FullDiskAtAnyByteIsReportedAndKeepsTheOldImage) {
  const std::vector<const char*> words = {"render",         "scene.toml", "-o",        "a.exr",
                                          "--reproducible", "-q",         "--samples", "1"};
  ASSERT_EQ(start(words).wait(), 0);
  const std::size_t whole = picture().size();
  put_old();
  std::mt19937 random(12);
  std::uniform_int_distribution<std::size_t> size(0, whole - 1);
  for (int i = 0; i < tries(); ++i) {
    const std::size_t bytes = i == 0 ? 0 : i == 1 ? whole - 1 : size(random);
    ASSERT_EQ(start(words, bytes).wait(), 74) << bytes;
    ASSERT_EQ(picture(), old_) << bytes;
    ASSERT_EQ(file_count(), 1) << "files left behind with a limit of " << bytes;
  }
}

TEST_F(BatchCrash, FailedCheckpointDoesNotStopTheRender) {
  // The image fits into the limit, the checkpoint does not.
  PacedProgram render =
      start({"render", "scene.toml", "-o", "a.exr", "--reproducible", "-t", "1", "--progress", "arnold"},
            right_.size() + 1000);
  ASSERT_TRUE(render.run_to(10));
  render.send(SIGUSR1);
  EXPECT_EQ(render.wait(), 0);
  EXPECT_NE(render.text().find("a.checkpoint.exr: warning: checkpoint not written: "), std::string::npos)
      << render.text();
  EXPECT_EQ(picture(), right_);
}

TEST_F(BatchCrash, FullFileSystemIsReportedBeforeRendering) {
  const std::string small = (folder_ / "small").string();
  std::filesystem::create_directory(small);
  if (std::system(("mount -t tmpfs -o size=64k tmpfs '" + small + "' 2>/dev/null").c_str()) != 0)
    GTEST_SKIP() << "no permission to mount a small file system";
  const Outcome r = run("render scene.toml -o small/a.exr --samples 100000000");
  EXPECT_EQ(r.status, 73);
  EXPECT_NE(r.err.find(" free; free some"), std::string::npos) << r.err;
  EXPECT_TRUE(std::filesystem::is_empty(small));
  EXPECT_EQ(std::system(("umount '" + small + "'").c_str()), 0);
}

TEST_F(BatchCrash, ReadOnlyFileSystemIsReported) {
  const std::string small = (folder_ / "small").string();
  std::filesystem::create_directory(small);
  if (std::system(("mount -t tmpfs -o ro tmpfs '" + small + "' 2>/dev/null").c_str()) != 0)
    GTEST_SKIP() << "no permission to mount a file system";
  const Outcome r = run("render scene.toml -o small/a.exr --samples 100000000");
  EXPECT_EQ(r.status, 73);
  EXPECT_NE(r.err.find("Read-only file system"), std::string::npos) << r.err;
  EXPECT_EQ(std::system(("umount '" + small + "'").c_str()), 0);
}

TEST_F(BatchCrash, RemovedOutputFolderIsReported) {
  std::filesystem::create_directory(folder_ / "out");
  PacedProgram render = start({"render", "scene.toml", "-o", "out/a.exr", "-t", "1", "--progress", "arnold"});
  ASSERT_TRUE(render.run_to(50));
  std::filesystem::remove_all(folder_ / "out");
  const int status = render.wait();
  EXPECT_TRUE(status == 73 || status == 74) << status;
}

TEST_F(BatchCrash, SamplesOutliveAFailedOutput) {
  std::filesystem::create_directory(folder_ / "out");
  const std::vector<const char*> words = {"render",    "scene.toml", "-o",     "a.exr",          "-o",
                                          "out/b.png", "-o",         "c.png",  "--reproducible", "-t",
                                          "1",         "--progress", "arnold", "--resume"};
  PacedProgram render = start(words);
  ASSERT_TRUE(render.run_to(50));
  std::filesystem::remove_all(folder_ / "out");
  EXPECT_EQ(render.wait(), 73);
  EXPECT_NE(render.text().find("a.checkpoint.exr holds the samples"), std::string::npos) << render.text();
  const std::string first = picture();
  support::write_bytes(folder_ / "right.exr", right_);
  EXPECT_EQ(run("compare a.exr right.exr -q --fail-above max=0").status, 0) << "an output before the failed one";
  EXPECT_TRUE(std::filesystem::exists(folder_ / "c.png")) << "an output after the failed one";

  put_old();
  std::filesystem::create_directory(folder_ / "out");
  PacedProgram again = start(words);
  EXPECT_EQ(again.wait(), 0) << again.text();
  EXPECT_TRUE(picture() == first);
  EXPECT_TRUE(text_of(folder_ / "out/b.png") == text_of(folder_ / "c.png"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "a.checkpoint.exr"));
}

TEST_F(BatchCrash, TwoProcessesWithOneOutputLeaveACompleteImage) {
  for (const int percent : {0, 50, 90}) {
    put_old();
    PacedProgram first = start(kRender);
    ASSERT_TRUE(first.run_to(percent));
    PacedProgram second = start(kRender);
    // From here on both write, in an order that the scheduler decides.
    std::thread other([&] { EXPECT_EQ(second.wait(), 0) << second.text(); });
    EXPECT_EQ(first.wait(), 0) << first.text();
    other.join();
    ASSERT_EQ(picture(), right_);
  }
}

TEST_F(BatchCrash, ThirtyInterruptionsGiveTheSameBytes) {
  ASSERT_EQ(run("render scene.toml -o whole.exr --samples 1000 --reproducible -q").status, 0);
  const std::vector<const char*> words = {"render",         "scene.toml", "-o",        "a.exr",
                                          "--reproducible", "--resume",   "--samples", "1000",
                                          "--progress",     "arnold",     "-t",        "1"};
  // One percent is two and a half tiles. A process pauses at most three percent after its first line, so there is work
  // left to interrupt all thirty times.
  for (int i = 0; i < 30; ++i) {
    PacedProgram render = start(words);
    ASSERT_TRUE(render.run_to(3 * i)) << "interruption " << i << "\n" << render.text();
    render.send(i % 2 == 0 ? SIGTERM : SIGINT);
    ASSERT_EQ(render.wait(), 75) << "interruption " << i << "\n" << render.text();
  }
  // The last run uses all threads.
  ASSERT_EQ(run("render scene.toml -o a.exr --samples 1000 --reproducible --resume -q").status, 0);
  EXPECT_EQ(picture(), text_of(folder_ / "whole.exr"));
}

}  // namespace
}  // namespace orrery::test
