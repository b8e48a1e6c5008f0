// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace orrery::job {

/// Default thread count: the minimum of the affinity mask's CPUs, the CPU quotas of the process's control groups,
/// SLURM_CPUS_PER_TASK and CUE_THREADS. A variable that is not a positive integer is ignored.
///
/// Domain     see base::control_groups
int default_threads(const std::filesystem::path& root = "/");

/// Limits kernel and accelerators to this instruction set; empty: that of the environment variable ORRERY_ISA, which is
/// for tests and comparisons, or else the best available.
///
/// Errors     base::Error(kUsage) if the program or the processor lacks it; the message lists the available ones
void choose_isa(const std::string& name = {});

}  // namespace orrery::job
