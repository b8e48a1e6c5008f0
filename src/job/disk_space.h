// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>

#include "job/job.h"
#include "compile/compiled_scene.h"

namespace orrery::job {

/// Bytes that the pictures of a job will take in each folder, as compressed as noisy pictures were measured to be.
///
/// Domain     `layer_planes` beside R, G, B, A
/// Precision  test AppDiskSpace.TheEstimateIsNearTheFiles
std::map<std::filesystem::path, double> estimate_disk_space(const Job& job, int width_px, int height_px,
                                                            std::size_t layer_planes);

/// Refuses a render whose pictures the disk has no room for, or that need more than the job's limit, which counts in
/// place of the room. Files that will be replaced stay until then and do not count as room.
///
/// Errors     base::Error(kCannotCreate) with both figures
void require_disk_space(const Job& job, const compile::CompiledScene& compiled, std::size_t layer_planes);

}  // namespace orrery::job
