// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "compile/compiled_scene.h"
#include "film/layers.h"

namespace orrery::job {

/// What a render will hold at its fullest, found without building anything. Bytes.
struct MemoryEstimate {
  std::uint64_t film = 0, spheres = 0, accelerator = 0;

  std::uint64_t total() const { return film + spheres + accelerator; }
};

/// What decides how much memory a render needs.
struct MemoryNeeds {
  int width = 0, height = 0;       ///< px
  std::uint64_t spheres = 0;       ///< of tables and of points files
  std::uint64_t layer_planes = 0;  ///< beside R, G, B, A
  bool layers = false;             ///< any layers, also those without planes of their own
  bool embree = true;              ///< and not the list
  bool in_rounds = false;          ///< by --noise or --time: a second half of each pixel's samples, and its error
};

/// The one estimate: of `info`, of `study`, and of the check before a render.
MemoryEstimate estimate_memory(const MemoryNeeds& needs);

/// The needs of a render of this world.
MemoryNeeds memory_needs(const compile::CompiledScene& compiled, const film::LayerRequest& layers,
                         bool in_rounds = false);

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

}  // namespace orrery::job
