// SPDX-License-Identifier: Apache-2.0
#include "base/control_group.h"

#include <gtest/gtest.h>

#include <string>

#include "support/temp_dir.h"

namespace orrery::base {
namespace {

/// A machine simulated by files.
class BaseControlGroup : public testing::Test {
 protected:
  void write(const std::string& file, const std::string& text) {
    std::filesystem::create_directories((root_ / file).parent_path());
    support::write_bytes(root_ / file, text);
  }
  std::optional<int> granted() { return granted_cpus(root_.path()); }

  support::TempDir root_;
};

TEST_F(BaseControlGroup, NoQuotaGrantsNothingInParticular) {
  EXPECT_FALSE(granted().has_value());
  write("proc/self/cgroup", "0::/job\n");
  write("sys/fs/cgroup/job/cpu.max", "max 100000\n");
  EXPECT_FALSE(granted().has_value());
}

TEST_F(BaseControlGroup, TheTightestQuotaOfVersionTwoIsRoundedUp) {
  write("proc/self/cgroup", "0::/job/step\n");
  write("sys/fs/cgroup/job/step/cpu.max", "800000 100000\n");
  EXPECT_EQ(granted(), 8);
  write("sys/fs/cgroup/job/cpu.max", "150000 100000\n");
  EXPECT_EQ(granted(), 2);
  write("sys/fs/cgroup/cpu.max", "1000 100000\n");
  EXPECT_EQ(granted(), 1);
}

TEST_F(BaseControlGroup, QuotasOfVersionOneCount) {
  write("proc/self/cgroup", "9:name=systemd:/\n4:cpu,cpuacct:/job\n2:cpuset:/job\n0::/\n");
  write("sys/fs/cgroup/cpu,cpuacct/job/cpu.cfs_period_us", "50000\n");
  write("sys/fs/cgroup/cpu,cpuacct/job/cpu.cfs_quota_us", "-1\n");
  EXPECT_FALSE(granted().has_value());
  write("sys/fs/cgroup/cpu,cpuacct/job/cpu.cfs_quota_us", "150000\n");
  EXPECT_EQ(granted(), 3);
}

/// A container sees its own group at the top, under the path that it has on the host.
TEST_F(BaseControlGroup, TheTopCountsIfTheGroupIsNotVisible) {
  write("proc/self/cgroup", "3:cpu:/docker/0123\n");
  write("sys/fs/cgroup/cpu/cpu.cfs_period_us", "100000\n");
  write("sys/fs/cgroup/cpu/cpu.cfs_quota_us", "400000\n");
  EXPECT_EQ(granted(), 4);
}

}  // namespace
}  // namespace orrery::base
