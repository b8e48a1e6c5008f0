// SPDX-License-Identifier: Apache-2.0
#include "job/check_job.h"

#include "job/choose_isa.h"
#include "job/job_files.h"
#include "base/atomic_file.h"
#include "base/error.h"
#include "image/format.h"

namespace orrery::job {
namespace {

/// A part is sums and nothing else: pictures are made of all parts together.
void check_shard(const Job& job) {
  const auto refuse = [](const std::string& text) { throw base::Error(base::ErrorKind::kUsage, text); };
  if (job.outputs.images.size() > 1 || job.outputs.images.front().format != image::Format::kExr ||
      !job.outputs.deep.empty())
    refuse("--samples A:B and --shard render a part, which is one EXR; orrery merge makes pictures of the parts");
  if (job.sampling.is_adaptive())
    refuse("--noise and --time decide by the whole picture; a part, by --samples A:B or --shard, has a fixed share");
}

}  // namespace

void check_request(const Job& job) {
  check_bits(job.outputs.images, job.outputs.bits);
  if (is_shard(job)) check_shard(job);
  if (!job.outputs.deep.empty() && image::format_of(job.outputs.deep) != image::Format::kExr)
    throw base::Error(base::ErrorKind::kUsage, job.outputs.deep.string() + " cannot hold samples in depth; EXR can");
  for (const OutputFile& output : outputs_of(job)) base::check_creatable(output.path);
  image::check_compression(job.outputs.exr.compression);
  choose_isa(job.resources.isa);
}

void check_samples(const Job& job, const compile::CompiledScene& compiled) {
  if (job.sampling.sample_end > static_cast<std::uint32_t>(compiled.samples))
    throw base::Error(
        base::ErrorKind::kUsage,
        "--samples " + std::to_string(job.sampling.sample_begin) + ":" + std::to_string(job.sampling.sample_end) +
            " goes beyond the scene's " + std::to_string(compiled.samples) +
            " samples; --set render.samples=" + std::to_string(job.sampling.sample_end) + " gives it more");
}

void check_sizes(const Job& job, const compile::CompiledScene& compiled) {
  for (const ImageFile& output : job.outputs.images) image::check_size(output.path, compiled.width, compiled.height);
}

}  // namespace orrery::job
