// SPDX-License-Identifier: Apache-2.0
// What is left of a render that is killed, runs out of disk, or loses its folder. ORRERY_CRASHES is the number of
// moments and of bytes that are tried; all are chosen by a fixed seed.
#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <random>
#include <thread>
#include <vector>

#include "cli/program.h"

namespace orrery::test {
namespace {

using Clock = std::chrono::steady_clock;

int tries() {
  const char* const text = std::getenv("ORRERY_CRASHES");
  return text != nullptr ? std::atoi(text) : 40;
}

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

class BatchCrash : public ProgramTest {
 protected:
  /// What the picture is when nothing goes wrong, and how long that takes.
  void SetUp() override {
    write("scene.toml", R"(
[image]
width = 160
height = 90
[render]
samples = 200
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
    const auto start = Clock::now();
    ASSERT_EQ(run("render scene.toml -o a.exr --reproducible -q").status, 0);
    seconds_ = seconds_since(start);
    right_ = text_of(folder_ / "a.exr");
    ASSERT_EQ(run("render scene.toml -o b.exr --reproducible -q --seed 5").status, 0);
    old_ = text_of(folder_ / "b.exr");
    ASSERT_NE(right_, old_);
    std::filesystem::remove(folder_ / "b.exr");
  }

  pid_t start(std::vector<const char*> words, rlim_t largest_file = RLIM_INFINITY) {
    words.insert(words.begin(), "orrery");
    words.push_back(nullptr);
    const pid_t child = fork();
    if (child != 0) return child;
    const rlimit limit{largest_file, largest_file};
    if (chdir(folder_.c_str()) != 0 || setrlimit(RLIMIT_FSIZE, &limit) != 0) _exit(126);
    const int out = open("/dev/null", O_WRONLY);
    dup2(out, 2);
    execv(ORRERY_PROGRAM, const_cast<char* const*>(words.data()));
    _exit(127);
  }
  static int wait_for(pid_t child) {
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  static void sleep_for(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }

  std::string picture() const { return text_of(folder_ / "a.exr"); }
  void put_old() const { support::write_bytes(folder_ / "a.exr", old_); }
  /// Temporary files of processes that nothing could tell to clean up.
  void remove_leftovers() const {
    for (const auto& entry : std::filesystem::directory_iterator(folder_))
      if (entry.path().filename().string().rfind(".a.", 0) == 0) std::filesystem::remove(entry.path());
  }

  std::string right_, old_;
  double seconds_ = 0;
};

const std::vector<const char*> kRender = {"render", "scene.toml",   "-o",   "a.exr",   "--reproducible",
                                          "-q",     "--checkpoint", "0.1s", "--resume"};

TEST_F(BatchCrash, KilledAtAnyMomentTheOldPictureOrTheNewOneIsThere) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> moment(0, 1.3 * seconds_);
  put_old();
  int finished = 0, interrupted = 0;
  for (int i = 0; i < tries(); ++i) {
    const pid_t child = start(kRender);
    sleep_for(moment(random));
    kill(child, SIGKILL);
    const int status = wait_for(child);
    ASSERT_TRUE(status == 0 || status == 128 + SIGKILL) << status;
    const std::string found = picture();
    ASSERT_TRUE(found == old_ || found == right_) << "killed at try " << i;
    ++(found == right_ ? finished : interrupted);
    if (found == right_) put_old();  // and from the beginning, or from the checkpoint of one killed just before its end
    remove_leftovers();
  }
  EXPECT_GT(interrupted, tries() / 4);
  // Whatever the last one left: it ends as if nothing had been.
  ASSERT_EQ(wait_for(start(kRender)), 0);
  EXPECT_EQ(picture(), right_);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "a.checkpoint.exr"));
  RecordProperty("finished", finished);
}

TEST_F(BatchCrash, AFullDiskAtAnyByteIsToldAndHarmless) {
  put_old();
  std::mt19937 random(12);
  std::uniform_int_distribution<std::size_t> size(0, right_.size() - 1);
  for (int i = 0; i < tries(); ++i) {
    const std::size_t bytes = i == 0 ? 0 : i == 1 ? right_.size() - 1 : size(random);
    ASSERT_EQ(wait_for(start({"render", "scene.toml", "-o", "a.exr", "--reproducible", "-q", "--samples", "1"}, bytes)),
              74)
        << bytes;
    ASSERT_EQ(picture(), old_) << bytes;
    ASSERT_EQ(file_count(), 1) << "something was left behind at " << bytes;
  }
}

TEST_F(BatchCrash, ACheckpointThatFindsNoRoomIsNoEndOfTheRender) {
  // The picture fits, its sums do not.
  put_old();
  EXPECT_EQ(wait_for(start({"render", "scene.toml", "-o", "a.exr", "--reproducible", "-q", "--checkpoint", "0.1s"},
                           right_.size() + 1000)),
            0);
  EXPECT_EQ(picture(), right_);
}

TEST_F(BatchCrash, ARealFullDiskIsToldBeforeAnythingIsRendered) {
  const std::string small = (folder_ / "small").string();
  std::filesystem::create_directory(small);
  if (std::system(("mount -t tmpfs -o size=64k tmpfs '" + small + "' 2>/dev/null").c_str()) != 0)
    GTEST_SKIP() << "no right to mount a small disk";
  const Outcome r = run("render scene.toml -o small/a.exr --samples 100000000");
  EXPECT_EQ(r.status, 73);
  EXPECT_NE(r.err.find("has room for"), std::string::npos) << r.err;
  EXPECT_TRUE(std::filesystem::is_empty(small));
  EXPECT_EQ(std::system(("umount '" + small + "'").c_str()), 0);
}

TEST_F(BatchCrash, AReadOnlyDiskIsTold) {
  const std::string small = (folder_ / "small").string();
  std::filesystem::create_directory(small);
  if (std::system(("mount -t tmpfs -o ro tmpfs '" + small + "' 2>/dev/null").c_str()) != 0)
    GTEST_SKIP() << "no right to mount a disk";
  const Outcome r = run("render scene.toml -o small/a.exr --samples 100000000");
  EXPECT_EQ(r.status, 73);
  EXPECT_NE(r.err.find("Read-only file system"), std::string::npos) << r.err;
  EXPECT_EQ(std::system(("umount '" + small + "'").c_str()), 0);
}

TEST_F(BatchCrash, AFolderThatVanishesIsTold) {
  std::filesystem::create_directory(folder_ / "out");
  const pid_t child = start({"render", "scene.toml", "-o", "out/a.exr", "-q"});
  sleep_for(seconds_ / 2);
  std::filesystem::remove_all(folder_ / "out");
  const int status = wait_for(child);
  EXPECT_TRUE(status == 73 || status == 74) << status;
}

TEST_F(BatchCrash, TwoProcessesOnOnePictureMakeOneWholePicture) {
  put_old();
  for (int i = 0; i < 5; ++i) {
    const pid_t a = start(kRender);
    sleep_for(seconds_ * i / 10);
    const pid_t b = start(kRender);
    EXPECT_EQ(wait_for(a), 0);
    EXPECT_EQ(wait_for(b), 0);
    ASSERT_EQ(picture(), right_);
  }
}

TEST_F(BatchCrash, InterruptedThirtyTimesItIsTheSameBytes) {
  ASSERT_EQ(run("render scene.toml -o whole.exr --samples 4000 --reproducible -q").status, 0);
  std::mt19937 random(13);
  const std::vector<const char*> words = {"render",    "scene.toml", "-o", "a.exr",         "--resume",
                                          "--samples", "4000",       "-q", "--reproducible"};
  std::uniform_real_distribution<double> moment(0.02, 20 * seconds_ / 31 * 2);
  int interruptions = 0, status = 75;
  while (status == 75) {
    const pid_t child = start(words);
    if (interruptions < 30) {
      sleep_for(moment(random));
      kill(child, interruptions % 2 == 0 ? SIGTERM : SIGINT);
    }
    status = wait_for(child);
    // A signal before the program listens ends it as any other.
    if (status == 128 + SIGTERM || status == 128 + SIGINT) status = 75;
    interruptions += status == 75 ? 1 : 0;
  }
  EXPECT_EQ(status, 0);
  EXPECT_GT(interruptions, 10);
  EXPECT_EQ(picture(), text_of(folder_ / "whole.exr"));
  RecordProperty("interruptions", interruptions);
}

}  // namespace
}  // namespace orrery::test
