// SPDX-License-Identifier: Apache-2.0
#include "job/check_job.h"

#include "job/choose_isa.h"
#include "job/job_files.h"
#include "job/output_files.h"
#include "base/atomic_file.h"
#include "base/error.h"
#include "image/format.h"

namespace orrery::job {
namespace {

/// A part is sums and nothing else: pictures are made of all parts together.
void check_shard(const Job& job) {
  const auto refuse = [](const std::string& text) { throw base::Error(base::ErrorKind::kUsage, text); };
  if (job.outputs.size() > 1 || image::format_of(job.outputs.front()) != image::Format::kExr || !job.deep.empty())
    refuse("--samples A:B and --tiles render a part, which is one EXR; orrery merge makes pictures of the parts");
  if (job.noise > 0 || job.seconds > 0)
    refuse("--noise and --time decide by the whole picture; a part, by --samples A:B or --tiles, has a fixed share");
}

}  // namespace

render::Traversal traversal_of(const Job& job) {
  if (job.traversal == "auto") return render::Traversal::kAuto;
  if (job.traversal == "packet") return render::Traversal::kPacket;
  if (job.traversal == "single") return render::Traversal::kSingle;
  throw base::Error(base::ErrorKind::kUsage, "no traversal " + job.traversal + "; there are auto, packet and single");
}

void check_request(const Job& job) {
  check_formats(job.outputs, job.bits);
  if (is_shard(job)) check_shard(job);
  if (!job.deep.empty() && image::format_of(job.deep) != image::Format::kExr)
    throw base::Error(base::ErrorKind::kUsage, job.deep.string() + " cannot hold samples in depth; EXR can");
  for (const OutputFile& output : outputs_of(job)) base::check_creatable(output.path);
  traversal_of(job);
  image::check_compression(job.exr.compression);
  choose_isa(job.isa);
}

void check_samples(const Job& job, const compile::CompiledScene& compiled) {
  if (job.sample_end > static_cast<std::uint32_t>(compiled.samples))
    throw base::Error(base::ErrorKind::kUsage,
                      "--samples " + std::to_string(job.sample_begin) + ":" + std::to_string(job.sample_end) +
                          " goes beyond the scene's " + std::to_string(compiled.samples) +
                          " samples; --set render.samples=" + std::to_string(job.sample_end) + " gives it more");
}

void check_sizes(const Job& job, const compile::CompiledScene& compiled) {
  for (const std::filesystem::path& output : job.outputs) image::check_size(output, compiled.width, compiled.height);
}

}  // namespace orrery::job
