// SPDX-License-Identifier: Apache-2.0
#include "job/make_picture.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "base/error.h"
#include "compile/compiled_scene.h"
#include "film/partial.h"
#include "film/picture.h"
#include "image/format.h"
#include "image/partial_file.h"
#include "image/verify.h"
#include "job/checkpoint.h"
#include "job/job.h"
#include "job/job_report.h"
#include "job/merge_shards.h"
#include "job/prepared_scene.h"
#include "job/provenance.h"
#include "render/render.h"
#include "render/result.h"
#include "render/settings.h"

namespace orrery::job {
namespace {

/// The sampling limits of a render that starts this many seconds after its job. The scene's sample count limits
/// adaptive sampling only if an override sets it.
render::SamplingLimits limits_of(const Job& job, double seconds_so_far) {
  render::SamplingLimits out = job.sampling;
  out.spend(seconds_so_far);
  out.unlimited = !is_limited(job);
  return out;
}

/// Returns whether a render with these settings can continue from these sums, even if their file is damaged.
bool is_of_this_render(const film::Partial& from, const compile::CompiledScene& compiled,
                       const render::Settings& settings) {
  return from.is_adaptive() == settings.sampling.is_adaptive() && from.layers.empty() != settings.layers.records() &&
         from.halves.empty() != settings.layers.guides() && from.has_known_spheres(compiled.spheres.size());
}

/// The accelerator; null if the job was cancelled while it was built.
accel::Accel* build(const Job& job, PreparedScene& prepared, int threads) {
  try {
    return &prepared.accelerator(threads, [&job](double fraction) {
      if (job.hooks.on_build) job.hooks.on_build(fraction);
      return job.hooks.cancel == nullptr || !job.hooks.cancel->load(std::memory_order_relaxed);
    });
  } catch (const base::Error& error) {
    if (error.kind() != base::ErrorKind::kStopped) throw;
    return nullptr;
  }
}

/// Requires that shards have the layers of the image.
void require_layers(const Job& job, const render::Settings& settings, const film::Partial& merged,
                    const ShardFile& first, const image::Provenance& provenance) {
  const auto fail = [](const std::string& text) { throw base::Error(base::ErrorKind::kBadData, text); };
  if (job.denoise && merged.halves.empty())
    fail("the shards have no halves to denoise from; render them with --denoise or --layers halves");
  // Other formats do not hold the layers that the shards may have.
  if (!job.outputs.has_exr()) return;
  if (!merged.halves.empty() && !settings.layers.guides())
    fail("the shards were rendered with --denoise; merge them with --denoise");
  if (const std::string wrong = difference(first.provenance, provenance, {"layers"}); !wrong.empty())
    fail(fmt::format("{} has {} as {}; the scene has changed, or --scene names another one", first.file.string(), wrong,
                     job.scene.file.string()));
}

}  // namespace

void stop_job(const std::string& remedy) {
  throw base::Error(base::ErrorKind::kStopped, "stopped; no image was written" + remedy);
}

film::Picture preview(const compile::CompiledScene& compiled, const film::Partial& partial) {
  return render::finished(compiled, {}, partial, 1).picture;
}

render::Result merge_job(const Job& job, const compile::CompiledScene& compiled, const render::Settings& settings,
                         const image::Provenance& provenance, JobReport& report) {
  const ShardFile& first = job.merge.shards.front();
  const std::vector<std::string> keys = {"version", "sceneHash"};
  if (const std::string wrong = difference(first.provenance, provenance, keys); !wrong.empty())
    throw base::Error(base::ErrorKind::kBadData,
                      fmt::format("{} has {} as {}; the scene has changed, or --scene names another one",
                                  first.file.string(), wrong, job.scene.file.string()));
  MergedShards merged =
      merge_shards(job.merge.shards, compiled.width, compiled.height, static_cast<std::uint32_t>(compiled.samples),
                   compiled.spheres.size(), job.merge.allow_missing);
  require_layers(job, settings, merged.partial, first, provenance);
  for (const base::Diagnostic& diagnostic : merged.left_out)
    if (job.hooks.on_warning) job.hooks.on_warning(diagnostic);
  report.missing = merged.missing;
  report.hosts = merged.hosts;
  const film::RenderWork work = merged.partial.work;
  const auto [fewest, most] = std::minmax_element(merged.partial.counts.begin(), merged.partial.counts.end());
  render::Statistics statistics;
  statistics.min_samples = *fewest;
  statistics.max_samples = *most;
  statistics.paths = work.paths;
  statistics.rays = work.rays;
  statistics.bad_samples = work.bad_samples;
  statistics.render_s = work.seconds;
  statistics.ended_by = "samples";
  if (!settings.layers.records()) merged.partial.layers.clear();
  if (!settings.layers.guides()) merged.partial.halves.clear();
  if ((settings.layers.records() && merged.partial.layers.empty()) ||
      (settings.layers.guides() && merged.partial.halves.empty()))
    throw base::Error(base::ErrorKind::kBadData, "the shards were rendered without the requested layers");
  render::Result result = render::finished(compiled, settings.layers, merged.partial, settings.threads);
  result.statistics = statistics;
  return result;
}

bool is_up_to_date(const Job& job, const compile::CompiledScene& compiled, const image::Provenance& provenance,
                   const std::string& stamp) {
  if (is_shard(job)) {
    try {
      const image::PartialFile shard =
          image::read_partial(job.outputs.images.front().path, compiled.width, compiled.height);
      return difference(shard.provenance, provenance, keys_of_files()).empty() && is_finished(shard);
    } catch (const base::Error&) {
      return false;
    }
  }
  const auto is_same = [&](const std::filesystem::path& file) { return image::verified_stamp(file) == stamp; };
  return std::all_of(job.outputs.images.begin(), job.outputs.images.end(),
                     [&](const ImageFile& image) { return is_same(image.path); }) &&
         (job.outputs.deep.empty() || is_same(job.outputs.deep));
}

render::Result render_job(const Job& job, PreparedScene& prepared, const compile::CompiledScene& compiled,
                          render::Settings settings, Checkpoint& checkpoint, double seconds_so_far, JobReport& report) {
  settings.sampling = limits_of(job, seconds_so_far);
  settings.snapshot_is_due = [&] { return checkpoint.is_due(); };
  settings.on_snapshot = [&](const film::Partial& partial) { checkpoint.write_snapshot(partial); };
  std::optional<film::Partial> from = checkpoint.load(compiled.width, compiled.height);
  report.was_resumed = from.has_value();
  if (from && !is_of_this_render(*from, compiled, settings))
    throw base::Error(base::ErrorKind::kBadData,
                      checkpoint.file().string() +
                          " contains sums that do not match its header; delete it, or render "
                          "without --resume to start again");
  const bool is_built = prepared.has_accelerator();
  const auto begin = std::chrono::steady_clock::now();
  accel::Accel* const accel = build(job, prepared, settings.threads);
  const double build_s = is_built ? 0 : std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  settings.sampling.spend(build_s);
  render::Result result;
  if (accel != nullptr) result = render::render(compiled, *accel, settings, std::move(from));
  result.statistics.build_s = build_s;
  report.render = result.statistics;
  report.phases.build_s = build_s;
  report.phases.render_s = result.statistics.render_s;
  report.phases.finish_s = result.statistics.finish_s;
  if (result.completed) return result;
  if (!result.partial || job.keep != nullptr)
    stop_job(report.was_resumed
                 ? fmt::format("; {} still holds the samples of the earlier run", checkpoint.file().string())
                 : "");
  checkpoint.write(*result.partial);
  report.checkpoint = checkpoint.file();
  stop_job(fmt::format("; {} holds the samples so far; continue with --resume", checkpoint.file().string()));
}

}  // namespace orrery::job
