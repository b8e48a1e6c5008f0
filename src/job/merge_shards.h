// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "job/job.h"
#include "film/partial.h"

namespace orrery::job {

/// Reads what parts say of themselves, and whether they are parts of one picture.
///
/// `on_left_out`  hears of files that are missing or damaged, and these are then left out; null: they are errors
/// Errors     base::Error with a finding for each file that is missing, damaged, or of another picture than the first:
///            kMissingInput where files are missing and nothing else is wrong, kBadData otherwise; kUsage for a file
///            that is given twice
std::vector<ShardFile> read_shards(const std::vector<std::filesystem::path>& files,
                                   const std::function<void(const base::Diagnostic&)>& on_left_out = nullptr);

/// The scene, its overrides, and the limits that a part was rendered with; what the job says already stays.
void take_scene(const ShardFile& part, Job& job);

/// The sum of all parts.
struct MergedShards {
  film::Partial partial;
  std::string missing;                     ///< in words; empty: each pixel has all its samples
  std::vector<std::string> hosts;          ///< that have rendered, each once
  std::vector<base::Diagnostic> left_out;  ///< damaged parts
};

/// Adds parts up, one at a time in memory. Whatever the order of the files, the sums are those of one render.
///
/// Domain     parts of read_shards; `samples` of a pixel in the whole picture, `spheres` in the scene
/// `allow_missing`  samples that no part has, and parts whose sums cannot be read, are no error
/// Errors     base::Error(kBadData) naming files that overlap, are unfinished or of another size, and what is missing
MergedShards merge_shards(std::vector<ShardFile> parts, int width_px, int height_px, std::uint32_t samples,
                          std::size_t spheres, bool allow_missing);

}  // namespace orrery::job
