// SPDX-License-Identifier: Apache-2.0
#include "job/machine.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <cstring>

#include <fmt/core.h>

#include "base/available_memory.h"
#include "base/error.h"
#include "base/text.h"
#include "kernel/isa.h"
#include "render/render.h"

namespace orrery::job {
namespace {

/// Threads that a scheduler grants; 0 if the variable is unset or not a positive integer.
int granted_by(const char* variable) {
  const char* const text = std::getenv(variable);
  if (text == nullptr) return 0;
  int granted = 0;
  const char* const end = text + std::strlen(text);
  const auto [stopped, error] = std::from_chars(text, end, granted);
  return error == std::errc() && stopped == end ? std::max(granted, 0) : 0;
}

}  // namespace

int default_threads(const std::filesystem::path& root) {
  int threads = std::max(1, render::available_threads());
  if (const auto granted = base::granted_cpus(root)) threads = std::min(threads, *granted);
  for (const char* variable : {"SLURM_CPUS_PER_TASK", "CUE_THREADS"})
    if (const int granted = granted_by(variable); granted > 0) threads = std::min(threads, granted);
  return threads;
}

void choose_isa(const std::string& name) {
  const char* const of_environment = std::getenv("ORRERY_ISA");
  const bool is_of_environment = name.empty() && of_environment != nullptr;
  const std::string isa = is_of_environment ? of_environment : name;
  if (kernel::limit_isa(isa)) return;
  throw base::Error(base::ErrorKind::kUsage,
                    fmt::format("{}instruction set {} is not available; this processor and program have {}",
                                is_of_environment ? "$ORRERY_ISA: " : "", isa, base::joined(kernel::available_isas())));
}

}  // namespace orrery::job
