// SPDX-License-Identifier: Apache-2.0
#include "base/available_memory.h"

#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace orrery::base {
namespace {

constexpr double kNoQuota = 1 << 20;  ///< more CPUs than any machine has

/// CPUs granted by "quota period", in microseconds. Without a quota, it is "max" or -1.
double granted_by(const std::string& text) {
  std::istringstream words(text);
  double quota = 0, period = 0;
  return words >> quota >> period && quota > 0 && period > 0 ? quota / period : kNoQuota;
}

std::string first_line(const std::filesystem::path& file) {
  std::string line;
  std::ifstream in(file);
  std::getline(in, line);
  return line;
}

/// The folders of the control groups that limit this process, with the files of a controller ("cpu", "memory") of
/// version 1 or 2: its own group and every group above it. In a container, its own may not be visible, but the top is.
///
/// Reference  cgroups(7)
std::vector<std::filesystem::path> control_groups(const std::string& controller, const std::filesystem::path& root) {
  std::vector<std::filesystem::path> out;
  // "0::/a/b" for version 2, "4:cpu,cpuacct:/a/b" for version 1: the process belongs to /a/b and to every group above.
  std::ifstream lines(root / "proc/self/cgroup");
  for (std::string line; std::getline(lines, line);) {
    const std::size_t names = line.find(':') + 1, path = line.find(":/", names);
    if (names == 0 || path == std::string::npos) continue;
    const std::string controllers = line.substr(names, path - names);
    const bool has_controller = ("," + controllers + ",").find("," + controller + ",") != std::string::npos;
    if (!controllers.empty() && !has_controller) continue;
    const std::filesystem::path top = root / "sys/fs/cgroup" / controllers;
    std::filesystem::path group = line.substr(path + 2);
    for (out.push_back(top / group); !group.empty(); out.push_back(top / group)) group = group.parent_path();
  }
  return out;
}

/// The number after `key` in a file of "key number unit" lines. An empty key reads a file of one number.
std::optional<std::uint64_t> number_in(const std::filesystem::path& file, const std::string& key = {}) {
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

std::optional<int> granted_cpus(const std::filesystem::path& root) {
  double fewest = kNoQuota;
  for (const std::filesystem::path& group : control_groups("cpu", root))
    for (const std::string& text : {first_line(group / "cpu.max"), first_line(group / "cpu.cfs_quota_us") + " " +
                                                                       first_line(group / "cpu.cfs_period_us")})
      fewest = std::min(fewest, granted_by(text));
  if (fewest == kNoQuota) return {};
  return static_cast<int>(std::ceil(fewest));
}

}  // namespace orrery::base
