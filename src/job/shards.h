// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "base/error.h"
#include "job/job.h"
#include "render/forward.h"

namespace orrery::job {

struct PreparedJob;

/// Reads the provenance of shards and checks that they belong to one image.
///
/// `on_left_out`  called for each missing or damaged file, which is then skipped; null: such files are errors
/// Errors     base::Error with a diagnostic for each file that is missing, damaged, or of another image than the first:
///            kMissingInput if files are missing and nothing else is wrong, kBadData otherwise; kUsage for a file that
///            is given twice
std::vector<ShardFile> read_shards(const std::vector<std::filesystem::path>& files,
                                   const std::function<void(const base::Diagnostic&)>& on_left_out = nullptr);

/// Sets the job's scene file, unless it is set, its overrides and its frame from a shard, and replaces the patterns in
/// the names of its outputs.
void take_scene(const ShardFile& shard, Job& job);

/// Merges the shards of a job instead of rendering: adds their sums, one shard at a time in memory. The sums equal
/// those of a single render, whatever the order of the files.
///
/// `report`   receives the machines that rendered the image, and which samples are missing
/// Domain     the shards are a result of read_shards
/// Errors     base::Error(kBadData) if the scene has changed since, or naming shards that overlap, are unfinished or of
///            another size, and missing samples
render::Result merge_shards(const PreparedJob& prepared, int threads, JobReport& report);

}  // namespace orrery::job
