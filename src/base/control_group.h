// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace orrery::base {

/// The folders of the control groups that limit this process, with the files of a controller ("cpu", "memory") of
/// version 1 or 2: its own group and every group above it. In a container, its own may not be visible, but the top is.
///
/// Domain     `root` is "/", or a folder in its place in tests
/// Reference  cgroups(7)
std::vector<std::filesystem::path> control_groups(const std::string& controller, const std::filesystem::path& root);

/// The number after `key` in a file of "key number unit" lines. An empty key reads a file of one number.
std::optional<std::uint64_t> number_in(const std::filesystem::path& file, const std::string& key = {});

/// The CPUs that the quotas of the process's control groups grant, rounded up; empty if there is no quota.
///
/// Reference  the kernel's documentation of control groups: cpu.max of version 2, cpu.cfs_quota_us of version 1
std::optional<int> granted_cpus(const std::filesystem::path& root = "/");

}  // namespace orrery::base
