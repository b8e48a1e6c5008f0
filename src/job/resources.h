// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "compile/forward.h"
#include "film/forward.h"
#include "job/job.h"
#include "scene/forward.h"

namespace orrery::job {

/// Default thread count: the minimum of the affinity mask's CPUs, the CPU quotas of the process's control groups,
/// SLURM_CPUS_PER_TASK and CUE_THREADS. A variable that is not a positive integer is ignored.
///
/// Domain     see base::available_memory
int default_threads(const std::filesystem::path& root = "/");

/// The requested number of threads; default_threads() if it is 0.
int thread_count(int requested);

/// Limits kernel and accelerators to the instruction set of the environment variable ORRERY_ISA, which is for tests and
/// comparisons; unset: the best available.
///
/// Errors     base::Error(kUsage) if the program or the processor lacks it; the message lists the available ones
void choose_isa();

/// Estimated peak memory of a render, in bytes, computed without building anything.
struct MemoryEstimate {
  std::uint64_t film = 0, spheres = 0, accelerator = 0, background = 0, textures = 0, lights = 0;

  std::uint64_t total() const { return film + spheres + accelerator + background + textures + lights; }
  /// The part that a compiled scene has already allocated.
  std::uint64_t held() const { return spheres + background + textures; }
};

/// What a render's memory depends on besides the scene and the layers.
struct MemoryUse {
  bool is_adaptive = false;       ///< with --noise or --time
  bool has_accelerator = false;   ///< there is one already, so that none is built
  bool keeps_sums = true;         ///< render::Settings::keeps_sums
  double share_with_objects = 1;  ///< see render::share_with_objects
};

/// Estimates the memory of a render for `info`, `study` and the check before a render.
MemoryEstimate estimate_memory(const compile::CompiledScene& compiled, const film::LayerRequest& layers,
                               const MemoryUse& use = {});

/// Formats the parts of an estimate: "film 1 MiB, spheres 2 MiB, accelerator 3 MiB".
std::string text_of(const MemoryEstimate& estimate);

/// Checks that a render fits into memory.
///
/// `limit`    bytes; 0: base::available_memory()
/// `held`     bytes of `needed` that are already allocated, and therefore no longer available
/// Errors     base::Error(kNoMemory) with the needed and the allowed size
void require_memory(const MemoryEstimate& needed, std::uint64_t limit, std::uint64_t held = 0);

/// The same for a scene that has been compiled. Empty pixels are only counted if it would not fit with none.
void require_memory(const compile::CompiledScene& compiled, const film::LayerRequest& layers, MemoryUse use,
                    std::uint64_t limit, int threads);

/// Checks that the spheres of data files fit into memory twice, as loaded and compiled.
///
/// `limit`    bytes; 0: base::available_memory()
/// Errors     base::Error(kNoMemory) with the needed and the allowed size
void require_memory_to_compile(const scene::Scene& scene, std::uint64_t limit);

/// Estimates the bytes that a job writes to each folder, with compression as measured for noisy images.
///
/// Precision  test JobDiskSpace.TheEstimateIsNearTheFiles
std::map<std::filesystem::path, double> estimate_disk_space(const Job& job, int width_px, int height_px,
                                                            const film::LayerRequest& layers);

/// Checks that a job's files fit on the disk. Files that will be replaced do not count as free space, since they exist
/// until then.
///
/// Errors     base::Error(kCannotCreate) with the needed and the allowed size
void require_disk_space(const Job& job, int width_px, int height_px, const film::LayerRequest& layers);

}  // namespace orrery::job
