// SPDX-License-Identifier: Apache-2.0
#include "job/job_files.h"

#include "job/checkpoint.h"
#include "job/job.h"
#include "job/matte_manifest.h"
#include "load/scene_files.h"

namespace orrery::job {
std::vector<OutputFile> outputs_of(const Job& job) {
  std::vector<OutputFile> out;
  for (const ImageFile& output : job.outputs.images) out.push_back({output.path, "-o"});
  if (!job.outputs.deep.empty()) out.push_back({job.outputs.deep, "--deep"});
  if (!job.outputs.statistics.empty()) out.push_back({job.outputs.statistics, "--stats"});
  if (job.merge.shards.empty() && job.keep == nullptr)
    out.push_back({checkpoint_file(job.outputs.images.front().path), "checkpoint"});
  return out;
}

void add_job_files(const Job& job, base::FileSet& files, const std::string& owner) {
  if (job.scene.has_file) files.add_input(job.scene.file, "scene");
  for (const ShardFile& shard : job.merge.shards) files.add_input(shard.file, "shard");
  load::add_ocio_configs(job.outputs.display.config, files);
  for (const OutputFile& output : outputs_of(job)) files.add_output(output.path, output.role + owner);
  if (is_shard(job)) return;
  for (const std::filesystem::path& manifest : possible_manifest_files(job.outputs))
    files.add_output(manifest, "Cryptomatte manifest" + owner);
}

}  // namespace orrery::job
