// SPDX-License-Identifier: Apache-2.0
#include "base/available_memory.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

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
  std::optional<int> granted() { return granted_cpus(root_.path()); }
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

TEST_F(BaseAvailableMemory, ControlGroupsOfVersionOneLimitToo) {
  write("proc/meminfo", "MemAvailable:   1048576 kB\n");
  write("proc/self/cgroup", "8:pids:/\n4:memory:/job\n0::/\n");
  write("sys/fs/cgroup/memory/job/memory.limit_in_bytes", "104857600\n");
  write("sys/fs/cgroup/memory/job/memory.usage_in_bytes", "83886080\n");
  write("sys/fs/cgroup/memory/job/memory.stat", "inactive_file 1\ntotal_inactive_file 20971520\n");
  EXPECT_EQ(available(), 40 * kMega);
  write("sys/fs/cgroup/memory/job/memory.limit_in_bytes", "9223372036854771712\n");
  EXPECT_EQ(available(), 1024 * kMega) << "a group without a limit";
}

TEST_F(BaseAvailableMemory, TheRootControlGroupLimitsToo) {
  write("proc/self/cgroup", "0::/\n");
  write("sys/fs/cgroup/memory.max", "10485760\n");
  write("sys/fs/cgroup/memory.current", "0\n");
  EXPECT_EQ(available(), 10 * kMega);
}

/// Small arrays below one that is still in use stay in the heap.
TEST(BaseReleaseFreedMemory, ReturnsSmallArrays) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers have their own heaps";
#endif
  const auto resident = [] {
    std::ifstream file("/proc/self/statm");
    std::int64_t pages = 0;
    file >> pages >> pages;
    return pages * sysconf(_SC_PAGESIZE);
  };
  constexpr std::size_t kBytes = 1 << 16;
  std::vector<std::unique_ptr<char[]>> arrays;
  for (int i = 0; i < 1024; ++i) arrays.push_back(std::make_unique<char[]>(kBytes));
  for (const auto& array : arrays) std::fill_n(array.get(), kBytes, '.');
  arrays.erase(arrays.begin(), arrays.end() - 1);
  const std::int64_t before = resident();
  release_freed_memory();
  EXPECT_LT(resident(), before - std::int64_t{32} * (1 << 20));
}

TEST_F(BaseAvailableMemory, NoQuotaGrantsNothingInParticular) {
  EXPECT_FALSE(granted().has_value());
  write("proc/self/cgroup", "0::/job\n");
  write("sys/fs/cgroup/job/cpu.max", "max 100000\n");
  EXPECT_FALSE(granted().has_value());
}

TEST_F(BaseAvailableMemory, TheTightestQuotaOfVersionTwoIsRoundedUp) {
  write("proc/self/cgroup", "0::/job/step\n");
  write("sys/fs/cgroup/job/step/cpu.max", "800000 100000\n");
  EXPECT_EQ(granted(), 8);
  write("sys/fs/cgroup/job/cpu.max", "150000 100000\n");
  EXPECT_EQ(granted(), 2);
  write("sys/fs/cgroup/cpu.max", "1000 100000\n");
  EXPECT_EQ(granted(), 1);
}

TEST_F(BaseAvailableMemory, QuotasOfVersionOneCount) {
  write("proc/self/cgroup", "9:name=systemd:/\n4:cpu,cpuacct:/job\n2:cpuset:/job\n0::/\n");
  write("sys/fs/cgroup/cpu,cpuacct/job/cpu.cfs_period_us", "50000\n");
  write("sys/fs/cgroup/cpu,cpuacct/job/cpu.cfs_quota_us", "-1\n");
  EXPECT_FALSE(granted().has_value());
  write("sys/fs/cgroup/cpu,cpuacct/job/cpu.cfs_quota_us", "150000\n");
  EXPECT_EQ(granted(), 3);
}

/// A container sees its own group at the top, under the path that it has on the host.
TEST_F(BaseAvailableMemory, TheTopCountsIfTheGroupIsNotVisible) {
  write("proc/self/cgroup", "3:cpu:/docker/0123\n");
  write("sys/fs/cgroup/cpu/cpu.cfs_period_us", "100000\n");
  write("sys/fs/cgroup/cpu/cpu.cfs_quota_us", "400000\n");
  EXPECT_EQ(granted(), 4);
}

}  // namespace
}  // namespace orrery::base
