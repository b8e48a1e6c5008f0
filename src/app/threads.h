// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace orrery::app {

/// Threads to use where nobody says: the smallest of the affinity mask, SLURM_CPUS_PER_TASK and CUE_THREADS.
int default_threads();

}  // namespace orrery::app
