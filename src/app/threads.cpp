// SPDX-License-Identifier: Apache-2.0
#include "app/threads.h"

#include <algorithm>
#include <cstdlib>

#include "render/render.h"

namespace orrery::app {

int default_threads() {
  int threads = std::max(1, render::available_threads());
  for (const char* variable : {"SLURM_CPUS_PER_TASK", "CUE_THREADS"}) {
    const char* const text = std::getenv(variable);
    const int granted = text != nullptr ? std::atoi(text) : 0;  // what is no number grants nothing and takes nothing
    if (granted > 0) threads = std::min(threads, granted);
  }
  return threads;
}

}  // namespace orrery::app
