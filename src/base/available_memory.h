// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace orrery::base {

/// Bytes that this process may still allocate: the machine's available memory, limited by the process's control groups.
/// Empty if neither is known.
///
/// Domain     `root` is "/", or a folder in its place in tests
/// Reference  proc_meminfo(5); the kernel's documentation of control groups: memory.max of version 2,
///            memory.limit_in_bytes of version 1
std::optional<std::uint64_t> available_memory(const std::filesystem::path& root = "/");

/// Returns freed memory to the operating system. The C library keeps that of arrays of up to 32 MiB.
void release_freed_memory();

/// The CPUs that the quotas of the process's control groups grant, rounded up; empty if there is no quota.
///
/// Reference  the kernel's documentation of control groups: cpu.max of version 2, cpu.cfs_quota_us of version 1
std::optional<int> granted_cpus(const std::filesystem::path& root = "/");

}  // namespace orrery::base
