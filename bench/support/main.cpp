// SPDX-License-Identifier: Apache-2.0
// The main function of all benchmark programs: Google Benchmark's, plus context that identifies a result.
#include <benchmark/benchmark.h>

#include <cstdio>
#include <exception>

#include "accel/accel.h"
#include "kernel/isa.h"

int main(int argc, char** argv) try {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::AddCustomContext("instruction_set", orrery::kernel::isa_name());
  benchmark::AddCustomContext("embree", orrery::accel::embree_version());
  benchmark::AddCustomContext("compiler", ORRERY_COMPILER);
  benchmark::AddCustomContext("build", ORRERY_BUILD_TYPE);
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s: error: %s\n", argv[0], error.what());
  return 1;
}
