// SPDX-License-Identifier: Apache-2.0
#include "job/check_job.h"

#include <filesystem>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "base/atomic_file.h"
#include "base/error.h"
#include "compile/compiled_scene.h"
#include "image/format.h"
#include "job/checkpoint.h"
#include "job/resources.h"
#include "load/read_scene.h"
#include "scene/scene.h"

namespace orrery::job {
namespace {

/// All files that a job writes.
std::vector<NamedOutput> outputs_of(const Job& job) {
  std::vector<NamedOutput> out;
  each_named(job.outputs, [&](const std::filesystem::path& file, const char* role) { out.push_back({file, role}); });
  if (job.merge.shards.empty() && !job.is_in_memory())
    out.push_back({checkpoint_file(job.outputs.images.front().path), "checkpoint"});
  return out;
}

/// A shard holds sums only; images are made from all shards together.
void check_shard(const Job& job) {
  if (job.outputs.images.size() > 1 || job.outputs.images.front().format != image::Format::kExr ||
      !job.outputs.deep.empty())
    base::refuse("--sample-range A:B and --shard write one shard, a single EXR; orrery merge makes images from shards");
  if (job.settings.is_adaptive())
    base::refuse("--noise and --time need the whole image; they cannot be combined with --sample-range A:B or --shard");
}

}  // namespace

void add_job_files(const Job& job, base::FileSet& files, const std::string& owner) {
  if (job.scene.has_file) files.add_input(job.scene.file, "scene");
  for (const ShardFile& shard : job.merge.shards) files.add_input(shard.file, "shard");
  load::add_ocio_configs(job.outputs.display.config, files);
  for (const NamedOutput& output : outputs_of(job)) files.reserve(output.path, output.role + owner);
}

void check_request(const Job& job) {
  check_bits(job.outputs.images, job.outputs.bits);
  if (is_shard(job)) check_shard(job);
  if (!job.outputs.deep.empty() && image::format_of(job.outputs.deep) != image::Format::kExr)
    base::refuse(job.outputs.deep.string() + " cannot hold deep samples; use EXR");
  if (!job.outputs.deep.empty() && job.denoise)
    base::refuse("--denoise does not filter deep samples; render --deep without --denoise, in a separate run");
  for (const NamedOutput& output : outputs_of(job)) base::check_creatable(output.path);
  image::check_compression(job.outputs.exr.compression);
  choose_isa();
}

void check_layers(const Job& job, const scene::Scene& scene) {
  if (!job.outputs.has_exr() && !job.is_in_memory() && job.merge.shards.empty() && !scene.output.layers.empty() &&
      job.scene.overrides.sets("output.layers"))
    base::refuse("no output can hold the requested layers; add -o FILE.exr");
}

void check_scene(const Job& job, const compile::CompiledScene& compiled) {
  if (job.settings.sample_end > static_cast<std::uint32_t>(compiled.samples))
    base::refuse(fmt::format("--sample-range {}:{} exceeds the scene's {} samples; raise them with --samples {}",
                             job.settings.sample_begin, job.settings.sample_end, compiled.samples,
                             job.settings.sample_end));
  for (const ImageFile& output : job.outputs.images) image::check_size(output.path, compiled.width, compiled.height);
}

}  // namespace orrery::job
