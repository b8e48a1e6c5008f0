// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "base/error.h"
#include "film/partial.h"
#include "job/shard_file.h"

namespace orrery::job {

struct Job;

/// Reads the provenance of shards and checks that they belong to one image.
///
/// `on_left_out`  called for each missing or damaged file, which is then skipped; null: such files are errors
/// Errors     base::Error with a diagnostic for each file that is missing, damaged, or of another image than the first:
///            kMissingInput if files are missing and nothing else is wrong, kBadData otherwise; kUsage for a file that
///            is given twice
std::vector<ShardFile> read_shards(const std::vector<std::filesystem::path>& files,
                                   const std::function<void(const base::Diagnostic&)>& on_left_out = nullptr);

/// Sets the job's scene file, unless it is set, its overrides and its frame from a shard, and replaces frame patterns
/// in the names of its outputs.
void take_scene(const ShardFile& shard, Job& job);

/// The sum of all shards.
struct MergedShards {
  film::Partial partial;
  std::string missing;                     ///< as text; empty: each pixel has all its samples
  std::vector<std::string> hosts;          ///< machines that rendered the shards, without duplicates
  std::vector<base::Diagnostic> left_out;  ///< damaged shards
};

/// Adds shards, one at a time in memory. The sums equal those of a single render, whatever the order of the files.
///
/// `samples`  per pixel of the whole image
/// `spheres`  in the scene
/// `allow_missing`  accepts missing samples and skips shards with unreadable sums
/// Domain     `shards` is a result of read_shards
/// Errors     base::Error(kBadData) naming files that overlap, are unfinished or of another size, and missing samples
MergedShards merge_shards(std::vector<ShardFile> shards, int width_px, int height_px, std::uint32_t samples,
                          std::size_t spheres, bool allow_missing);

}  // namespace orrery::job
