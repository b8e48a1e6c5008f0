// SPDX-License-Identifier: Apache-2.0
#include "base/available_memory.h"

#include <malloc.h>

#include <algorithm>

#include "base/control_group.h"

namespace orrery::base {
namespace {

/// Bytes that a control group of version 1 or 2 still allows; empty if it has no limit.
std::optional<std::uint64_t> group_allowance(const std::filesystem::path& group) {
  const bool is_version_2 = std::filesystem::exists(group / "memory.max");
  const auto limit = number_in(group / (is_version_2 ? "memory.max" : "memory.limit_in_bytes"));  // "max" is no number
  const auto used = number_in(group / (is_version_2 ? "memory.current" : "memory.usage_in_bytes"));
  if (!limit || !used) return {};
  // The page cache counts as used, but is evicted when memory is needed.
  const std::uint64_t files =
      number_in(group / "memory.stat", is_version_2 ? "inactive_file" : "total_inactive_file").value_or(0);
  const std::uint64_t held = *used - std::min(files, *used);
  return *limit - std::min(held, *limit);
}

}  // namespace

std::optional<std::uint64_t> available_memory(const std::filesystem::path& root) {
  std::optional<std::uint64_t> least;
  const auto at_most = [&](std::optional<std::uint64_t> bytes) {
    if (bytes && (!least || *bytes < *least)) least = bytes;
  };
  if (const auto kib = number_in(root / "proc/meminfo", "MemAvailable:")) at_most(*kib * 1024);
  for (const std::filesystem::path& group : control_groups("memory", root)) at_most(group_allowance(group));
  return least;
}

void release_freed_memory() { malloc_trim(0); }

}  // namespace orrery::base
