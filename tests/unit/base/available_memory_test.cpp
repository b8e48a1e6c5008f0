// SPDX-License-Identifier: Apache-2.0
#include "base/available_memory.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "support/temp_dir.h"

namespace orrery::base {
namespace {

constexpr std::uint64_t kMega = 1 << 20;

/// A machine simulated by files.
class BaseAvailableMemory : public testing::Test {
 protected:
  void write(const std::string& file, const std::string& text) {
    std::filesystem::create_directories((root_ / file).parent_path());
    support::write_bytes(root_ / file, text);
  }
  std::optional<std::uint64_t> available() { return available_memory(root_.path()); }

  support::TempDir root_;
};

TEST_F(BaseAvailableMemory, IsEmptyIfUnknown) { EXPECT_FALSE(available().has_value()); }

TEST_F(BaseAvailableMemory, ReadsTheAvailableMemoryOfTheMachine) {
  write("proc/meminfo", "MemTotal:       8192 kB\nMemFree:  1024 kB\nMemAvailable:   4096 kB\n");
  EXPECT_EQ(available(), 4 * kMega);
}

TEST_F(BaseAvailableMemory, TheTightestControlGroupLimits) {
  write("proc/meminfo", "MemAvailable:   1048576 kB\n");
  write("proc/self/cgroup", "0::/job/step\n");
  write("sys/fs/cgroup/job/step/memory.max", "max\n");
  write("sys/fs/cgroup/job/step/memory.current", "1048576\n");
  EXPECT_EQ(available(), 1024 * kMega) << "a group without a limit";
  write("sys/fs/cgroup/job/memory.max", "104857600\n");
  write("sys/fs/cgroup/job/memory.current", "62914560\n");
  EXPECT_EQ(available(), 40 * kMega);
  write("sys/fs/cgroup/job/memory.stat", "anon 5\ninactive_file 20971520\n");
  EXPECT_EQ(available(), 60 * kMega) << "the page cache can be evicted";
  write("sys/fs/cgroup/job/memory.current", "209715200\n");
  EXPECT_EQ(available(), 0u) << "zero, without wrapping";
}

TEST_F(BaseAvailableMemory, TheRootControlGroupLimitsToo) {
  write("proc/self/cgroup", "0::/\n");
  write("sys/fs/cgroup/memory.max", "10485760\n");
  write("sys/fs/cgroup/memory.current", "0\n");
  EXPECT_EQ(available(), 10 * kMega);
}

}  // namespace
}  // namespace orrery::base
