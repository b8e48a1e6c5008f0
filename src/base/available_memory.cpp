// SPDX-License-Identifier: Apache-2.0
#include "base/available_memory.h"

#include <malloc.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string>

namespace orrery::base {
namespace {

/// The number after `key` in a file of "key number unit" lines. An empty key reads a file of one number.
std::optional<std::uint64_t> number_in(const std::filesystem::path& file, const std::string& key) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string word = key;
    std::uint64_t number = 0;
    if (!key.empty()) words >> word;
    if (word == key && words >> number) return number;
  }
  return {};
}

/// Bytes that a control group still allows; empty if it has no limit.
std::optional<std::uint64_t> group_allowance(const std::filesystem::path& group) {
  const auto limit = number_in(group / "memory.max", "");  // "max" is no number
  const auto used = number_in(group / "memory.current", "");
  if (!limit || !used) return {};
  // The page cache counts as used, but is evicted when memory is needed.
  const std::uint64_t files = number_in(group / "memory.stat", "inactive_file").value_or(0);
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

  // "0::/a/b": this process belongs to /a/b and to every group above it.
  std::ifstream groups(root / "proc/self/cgroup");
  for (std::string line; std::getline(groups, line);) {
    if (line.rfind("0::/", 0) != 0) continue;
    const std::filesystem::path top = root / "sys/fs/cgroup";
    std::filesystem::path group = line.substr(4);
    for (at_most(group_allowance(top / group)); !group.empty(); at_most(group_allowance(top / group)))
      group = group.parent_path();
  }
  return least;
}

void release_freed_memory() { malloc_trim(0); }

}  // namespace orrery::base
