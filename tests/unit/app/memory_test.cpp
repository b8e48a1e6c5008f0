// SPDX-License-Identifier: Apache-2.0
#include "app/memory.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "support/scratch_folder.h"

namespace orrery::app {
namespace {

constexpr std::uint64_t kMega = 1 << 20;

/// A machine made of files.
class AppMemory : public testing::Test {
 protected:
  void write(const std::string& file, const std::string& text) {
    std::filesystem::create_directories((root_ / file).parent_path());
    support::write_bytes(root_ / file, text);
  }
  std::optional<std::uint64_t> available() { return available_memory(root_.path()); }

  support::ScratchFolder root_;
};

TEST_F(AppMemory, NothingIsKnownWhereNothingIsTold) { EXPECT_FALSE(available().has_value()); }

TEST_F(AppMemory, TheMachineTellsWhatIsFree) {
  write("proc/meminfo", "MemTotal:       8192 kB\nMemFree:  1024 kB\nMemAvailable:   4096 kB\n");
  EXPECT_EQ(available(), 4 * kMega);
}

TEST_F(AppMemory, TheTightestGroupCounts) {
  write("proc/meminfo", "MemAvailable:   1048576 kB\n");
  write("proc/self/cgroup", "0::/job/step\n");
  write("sys/fs/cgroup/job/step/memory.max", "max\n");
  write("sys/fs/cgroup/job/step/memory.current", "1048576\n");
  EXPECT_EQ(available(), 1024 * kMega) << "a group without a limit";
  write("sys/fs/cgroup/job/memory.max", "104857600\n");
  write("sys/fs/cgroup/job/memory.current", "62914560\n");
  EXPECT_EQ(available(), 40 * kMega);
  write("sys/fs/cgroup/job/memory.stat", "anon 5\ninactive_file 20971520\n");
  EXPECT_EQ(available(), 60 * kMega) << "files that were read can go";
  write("sys/fs/cgroup/job/memory.current", "209715200\n");
  EXPECT_EQ(available(), 0u) << "nothing, not a huge number";
}

TEST_F(AppMemory, TheGroupOfTheWholeMachineCountsToo) {
  write("proc/self/cgroup", "0::/\n");
  write("sys/fs/cgroup/memory.max", "10485760\n");
  write("sys/fs/cgroup/memory.current", "0\n");
  EXPECT_EQ(available(), 10 * kMega);
}

TEST(AppMemoryEstimate, GrowsWithPixelsAndSpheres) {
  EXPECT_EQ(estimate_memory(10, 10, 0, 0, true).total(), estimate_memory(10, 10, 0, 0, false).total());
  EXPECT_EQ(estimate_memory(20, 10, 0, 0, true).film, 2 * estimate_memory(10, 10, 0, 0, true).film);
  EXPECT_GT(estimate_memory(10, 10, 3, 0, true).film, estimate_memory(10, 10, 0, 0, true).film);
  EXPECT_EQ(estimate_memory(1, 1, 0, 100, false).accelerator, 0u);
  EXPECT_EQ(estimate_memory(1, 1, 0, 100, true).accelerator, 100 * estimate_memory(1, 1, 0, 1, true).accelerator);
}

TEST(AppMemoryEstimate, WhatDoesNotFitIsRefusedWithTheFigure) {
  const MemoryEstimate million = estimate_memory(1, 1, 0, 1'000'000, true);
  EXPECT_NO_THROW(require_memory(million, million.total()));
  try {
    require_memory(million, million.total() - 1);
    FAIL();
  } catch (const base::Error& error) {
    EXPECT_EQ(error.kind(), base::ErrorKind::kNoMemory);
    EXPECT_NE(std::string(error.what()).find("needs about 158.3 MiB"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("--memory-limit"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace orrery::app
