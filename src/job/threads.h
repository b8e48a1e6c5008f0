// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace orrery::job {

/// Threads to use where nobody says: the smallest of the affinity mask, SLURM_CPUS_PER_TASK and CUE_THREADS. A variable
/// that holds no whole number above 0 counts as not set.
int default_threads();

}  // namespace orrery::job
