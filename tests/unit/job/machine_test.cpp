// SPDX-License-Identifier: Apache-2.0
#include "job/machine.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "render/render.h"
#include "support/temp_dir.h"

namespace orrery::job {
namespace {

class JobMachine : public testing::Test {
 protected:
  JobMachine() { TearDown(); }
  void TearDown() override {
    ::unsetenv("SLURM_CPUS_PER_TASK");
    ::unsetenv("CUE_THREADS");
  }
  const int all_ = render::available_threads();
};

TEST_F(JobMachine, DefaultIsTheAffinityMask) { EXPECT_EQ(default_threads(), all_); }

TEST_F(JobMachine, SchedulersLimitTheDefault) {
  ::setenv("SLURM_CPUS_PER_TASK", "1", 1);
  EXPECT_EQ(default_threads(), 1);
  ::unsetenv("SLURM_CPUS_PER_TASK");
  ::setenv("CUE_THREADS", "1", 1);
  EXPECT_EQ(default_threads(), 1);
}

TEST_F(JobMachine, QuotasOfControlGroupsLimitTheDefault) {
  const support::TempDir root;
  std::filesystem::create_directories(root / "proc/self");
  std::filesystem::create_directories(root / "sys/fs/cgroup");
  support::write_bytes(root / "proc/self/cgroup", "0::/\n");
  support::write_bytes(root / "sys/fs/cgroup/cpu.max", "50000 100000\n");
  EXPECT_EQ(default_threads(root.path()), 1);
}

TEST_F(JobMachine, SchedulersCannotExceedTheAffinityMask) {
  ::setenv("SLURM_CPUS_PER_TASK", "100000", 1);
  EXPECT_EQ(default_threads(), all_);
}

TEST_F(JobMachine, InvalidVariablesAreIgnored) {
  for (const char* text : {"", "abc", "0", "-1", "1x", "99999999999999999999"}) {
    ::setenv("SLURM_CPUS_PER_TASK", text, 1);
    EXPECT_EQ(default_threads(), all_) << text;
  }
}

}  // namespace
}  // namespace orrery::job
