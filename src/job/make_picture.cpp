// SPDX-License-Identifier: Apache-2.0
#include "job/make_picture.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "job/merge_shards.h"
#include "job/provenance.h"
#include "base/error.h"
#include "image/format.h"
#include "image/verify.h"

namespace orrery::job {
namespace {

/// When to stop sampling. The samples of the scene limit what is asked for otherwise only if they were asked for, too.
void set_target(const Job& job, double seconds_so_far, render::Settings& settings) {
  constexpr double kLeastTime = 1e-3;  // nothing left is not no limit
  settings.noise = job.noise;
  if (job.seconds > 0) settings.seconds = std::max(job.seconds - seconds_so_far, kLeastTime);
  settings.unlimited = !is_limited(job);
}

}  // namespace

void stop_job(const std::string& remedy) {
  throw base::Error(base::ErrorKind::kStopped, "stopped; no picture was written" + remedy);
}

film::Picture preview(const compile::CompiledScene& compiled, const film::Partial& partial) {
  film::Partial shown(0, 0);
  shown.film = partial.film;
  shown.second = partial.second;
  return render::finished(compiled, {}, std::move(shown)).picture;
}

render::Result merge_job(const Job& job, const compile::CompiledScene& compiled, const Layers& layers,
                         const image::Provenance& provenance, JobReport& report) {
  const ShardFile& first = job.parts.front();
  std::vector<std::string> keys = {"version", "sceneHash"};
  const auto is_exr = [](const auto& file) { return image::format_of(file) == image::Format::kExr; };
  // Other files have no use for the layers that the parts may have.
  if (std::any_of(job.outputs.begin(), job.outputs.end(), is_exr)) keys.push_back("layers");
  if (const std::string wrong = difference(first.provenance, provenance, keys); !wrong.empty())
    throw base::Error(base::ErrorKind::kBadData, first.file.string() + " is of " + wrong + ", which " +
                                                     job.scene.string() +
                                                     " comes to now; the scene has changed, or --scene names another");
  MergedShards joined =
      merge_shards(job.parts, compiled.width, compiled.height, static_cast<std::uint32_t>(compiled.samples),
                   compiled.spheres.size(), job.allow_missing);
  for (const base::Diagnostic& diagnostic : joined.left_out)
    if (job.on_warning) job.on_warning(diagnostic);
  report.missing = joined.missing;
  report.hosts = joined.hosts;
  const film::RenderWork work = joined.partial.work;
  const auto [fewest, most] = std::minmax_element(joined.partial.counts.begin(), joined.partial.counts.end());
  render::Statistics statistics;
  statistics.fewest_samples = *fewest;
  statistics.most_samples = *most;
  statistics.paths = work.paths;
  statistics.rays = work.rays;
  statistics.bad_samples = work.bad_samples;
  statistics.render_s = work.seconds;
  statistics.ended_by = "samples";
  if (!layers.request.any()) joined.partial.layers.clear();
  if (joined.partial.layers.empty() && layers.request.any())
    throw base::Error(base::ErrorKind::kBadData, "the parts were rendered without the layers that are asked for");
  render::Result result = render::finished(compiled, layers.request, std::move(joined.partial));
  result.statistics = statistics;
  return result;
}

bool is_there(const Job& job, const compile::CompiledScene& compiled, const image::Provenance& provenance,
              const std::string& stamp) {
  if (is_shard(job)) {
    try {
      const image::PartialFile part = image::read_partial(job.outputs.front(), compiled.width, compiled.height);
      return difference(part.provenance, provenance, keys_of_checkpoints()).empty() && is_finished(part);
    } catch (const base::Error&) {
      return false;
    }
  }
  const auto is_same = [&](const std::filesystem::path& file) { return image::verified_stamp(file) == stamp; };
  return std::all_of(job.outputs.begin(), job.outputs.end(), is_same) && (job.deep.empty() || is_same(job.deep));
}

render::Result render_job(const Job& job, const compile::CompiledScene& compiled, render::Settings settings,
                          Checkpoint& checkpoint, double seconds_so_far, JobReport& report) {
  set_target(job, seconds_so_far, settings);
  settings.sample_begin = job.sample_begin;
  settings.sample_end = job.sample_end;
  settings.shard = job.shard;
  settings.keep_partial = is_shard(job);
  settings.snapshot_is_due = [&] { return checkpoint.is_due(); };
  settings.on_snapshot = [&](const film::Partial& partial) { checkpoint.write_snapshot(partial); };
  std::optional<film::Partial> from = checkpoint.load(compiled.width, compiled.height);
  report.was_resumed = from.has_value();
  render::Result result = render::render(compiled, settings, std::move(from));
  report.render = result.statistics;
  report.phases.build_s = result.statistics.build_s;
  report.phases.render_s = result.statistics.render_s;
  report.phases.finish_s = result.statistics.finish_s;
  if (result.completed) return result;
  if (!result.partial)
    stop_job(report.was_resumed ? "; " + checkpoint.file().string() + " still keeps what was rendered before" : "");
  checkpoint.write(*result.partial);
  report.checkpoint = checkpoint.file();
  stop_job("; " + checkpoint.file().string() + " keeps what was rendered, and --resume goes on from there");
}

}  // namespace orrery::job
