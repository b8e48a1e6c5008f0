// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace orrery::app {

/// What a render will hold at its fullest, found without building anything. Bytes.
struct MemoryEstimate {
  std::uint64_t film = 0, spheres = 0, accelerator = 0;

  std::uint64_t total() const { return film + spheres + accelerator; }
};

/// Domain     `layer_planes` beside R, G, B, A; `spheres` counts those of tables and of points files
MemoryEstimate estimate_memory(int width, int height, std::uint64_t layer_planes, std::uint64_t spheres, bool embree);

/// What a render holds beside that in order to go on: each pixel's count; with layers all that is known of its paths so
/// far; in rounds a second half of its samples, and its error. Bytes.
std::uint64_t estimate_state(int width, int height, bool in_rounds, bool has_layers);

/// Bytes that this process may still take: what the machine has free or can free at once, and no more than its control
/// group still grants. Nothing where neither can be told.
///
/// Source     proc_meminfo(5); the kernel's documentation of control groups, version 2, memory.max
/// Domain     `root` is "/", or a folder that stands for it in tests
std::optional<std::uint64_t> available_memory(const std::filesystem::path& root = "/");

/// Refuses what does not fit, before it is begun.
///
/// Domain     `limit` is what the user allows; 0: what available_memory() says
/// Errors     base::Error(kNoMemory) with both figures and the remedy
void require_memory(const MemoryEstimate& needed, std::uint64_t limit);

}  // namespace orrery::app
