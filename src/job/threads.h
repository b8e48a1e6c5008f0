// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace orrery::job {

/// Default thread count: the minimum of the affinity mask's CPUs, SLURM_CPUS_PER_TASK and CUE_THREADS. A variable that
/// is not a positive integer is ignored.
int default_threads();

}  // namespace orrery::job
