// SPDX-License-Identifier: Apache-2.0
#include "job/job.h"

#include <chrono>
#include <new>
#include <optional>
#include <utility>

#include <fmt/core.h>

#include "base/atomic_file.h"
#include "base/available_memory.h"
#include "base/error.h"
#include "base/stop_point.h"
#include "base/text.h"
#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "compile/environment.h"
#include "denoise/denoise.h"
#include "display/picture_info.h"
#include "film/layer_film.h"
#include "film/partial.h"
#include "format/read_result.h"
#include "image/format.h"
#include "image/library.h"
#include "image/partial_file.h"
#include "job/check_job.h"
#include "job/checkpoint.h"
#include "job/disk_space.h"
#include "job/job_files.h"
#include "job/job_report.h"
#include "job/layers.h"
#include "job/machine.h"
#include "job/make_picture.h"
#include "job/matte_manifest.h"
#include "job/memory.h"
#include "job/picture_header.h"
#include "job/prepared_scene.h"
#include "job/provenance.h"
#include "job/rendering.h"
#include "job/statistics.h"
#include "job/version.h"
#include "job/write_outputs.h"
#include "load/load_scene.h"
#include "load/loaded_scene.h"
#include "load/scene_files.h"
#include "render/result.h"
#include "render/settings.h"
#include "scene/layers.h"

namespace orrery::job {
namespace {

/// Seconds since the last call.
class Stopwatch {
 public:
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    return seconds;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

void stop_if_cancelled(const Job& job) {
  if (job.hooks.cancel != nullptr && job.hooks.cancel->load(std::memory_order_relaxed)) stop_job();
}

void warn(const Job& job, const base::Diagnostic& diagnostic) {
  if (job.hooks.on_warning) job.hooks.on_warning(diagnostic);
}

/// Loads the scene and checks it against the job's output formats.
const load::LoadedScene& load(const Job& job, PreparedScene& prepared, JobReport& report) {
  const bool writes_display_format = job.outputs.has_display_format();
  load::SceneRequest request{job.scene, job.outputs.display, writes_display_format || job.hooks.develops_pixels};
  request.memory_limit = job.resources.memory_limit;
  const load::LoadedScene& loaded = prepared.load(std::move(request));
  for (const base::Diagnostic& warning : loaded.warnings) warn(job, warning);
  if (writes_display_format) {
    report.display = *loaded.choice;
    require_bits(report.display, job.outputs);
  }
  return loaded;
}

/// The layers that an output of the job holds; others are not computed.
Layers layers_for(const Job& job, const scene::Scene& scene, const compile::CompiledScene& compiled) {
  Layers layers = choose_layers(scene, compiled);
  layers.request.deep = !job.outputs.deep.empty();
  layers.request.halves = layers.request.halves || job.denoise;
  image::check_lossless(film::planes_of(layers.request), job.outputs.exr);
  check_layers(job, scene);
  if (job.outputs.has_exr() || job.keep != nullptr) return layers;
  Layers none;
  none.request.coverage = layers.request.coverage;
  none.request.deep = layers.request.deep;
  none.request.halves = job.denoise;
  return none;
}

void count_bad_values(const film::Picture& picture, JobReport& report) {
  for (const film::Plane& plane : picture.planes) {
    if (film::is_half(plane.name)) continue;  // NaN without samples
    const film::BadValues bad = film::count_bad_values(plane);
    if (!bad.any()) continue;
    report.bad_values += bad;
    const std::string layer = plane.layer().empty() ? "beauty" : plane.layer();
    if (report.bad_layers.empty() || report.bad_layers.back().first != layer) report.bad_layers.push_back({layer, {}});
    report.bad_layers.back().second += bad;
  }
}

std::string missed_target(const Job& job, const render::Statistics& statistics) {
  std::string out;
  const bool ended_by_time = statistics.ended_by == "time";
  if (job.sampling.noise > 0 && statistics.noise && *statistics.noise > job.sampling.noise)
    out = fmt::format("noise {:.3g} instead of {:.3g}: {}", *statistics.noise, job.sampling.noise,
                      ended_by_time ? "the time budget ended" : "the pixels that need more samples reached the limit");
  if (job.sampling.noise > 0 && statistics.unreliable_pixels > 0)
    out +=
        fmt::format("{}the noise of {} pixels cannot be estimated: too few paths found light near them; allow more {}",
                    out.empty() ? "" : "; ", statistics.unreliable_pixels, ended_by_time ? "time" : "samples");
  return out;
}

render::Settings settings_of(const Job& job, const scene::Scene& scene, const film::LayerRequest& layers) {
  render::Settings out;
  out.threads = job.resources.threads > 0 ? job.resources.threads : default_threads();
  if (scene.render.traversal == scene::Traversal::kPacket) out.traversal = accel::Traversal::kPacket;
  if (scene.render.traversal == scene::Traversal::kSingle) out.traversal = accel::Traversal::kSingle;
  out.layers = layers;
  out.on_progress = job.hooks.on_progress;
  out.on_build = job.hooks.on_build;
  out.on_pixels = job.hooks.on_pixels;
  out.cancel = job.hooks.cancel;
  return out;
}

/// Denoises the image, and removes the halves unless the scene requests them.
void denoise_picture(const Job& job, const scene::Scene& scene, int threads, film::Picture& picture) {
  if (!denoise::denoise(picture, threads).missing.empty())
    warn(job, base::file_diagnostic(base::Severity::kWarning, job.scene.file.string(),
                                    "the noise cannot be measured, because one half of the samples is missing; the "
                                    "image is hardly denoised",
                                    "render at least 2 samples per pixel"));
  if (job.hooks.on_denoised) job.hooks.on_denoised(picture);
  if (!base::contains(scene::requested_layers(scene), scene::kHalvesLayer)) denoise::remove_halves(picture);
}

/// The header of the finished image.
image::Header finished_header(const Job& job, const format::ReadResult& read, const compile::CompiledScene& compiled,
                              const JobReport& report, bool reproducible) {
  image::Header header = picture_header(read, compiled, report, reproducible);
  if (job.denoise) header.attributes.push_back({denoise::kAttribute, "orrery " + program_version()});
  return header;
}

/// Keeps the image in memory instead of writing files.
void keep(const Job& job, const format::ReadResult& read, const compile::CompiledScene& compiled, const Layers& layers,
          const image::Provenance& provenance, const display::Settings& display, const base::FileSet& files,
          film::Picture picture, const JobReport& report) {
  Rendering& out = *job.keep;
  out.job = job;
  out.job.hooks = {};
  out.job.keep = nullptr;
  out.job.scene.open_data = {};
  out.picture = std::move(picture);
  out.header = finished_header(job, read, compiled, report, false);
  out.reproducible_header = finished_header(job, read, compiled, report, true);
  out.mattes = layers.mattes;
  out.display = display;
  out.provenance = provenance;
  out.report = report;
  out.files = files;
}

/// Ends a job whose image could not be written: writes a checkpoint, so that the samples are not lost.
[[noreturn]] void save_samples(const base::Error& error, const film::Partial& partial, Checkpoint& checkpoint,
                               JobReport& report) {
  try {
    checkpoint.write(partial);
  } catch (const base::Error& also) {
    throw base::Error(error.kind(),
                      fmt::format("{}; the checkpoint cannot be written, either: {}", error.what(), also.what()));
  }
  report.checkpoint = checkpoint.file();
  throw base::Error(error.kind(),
                    fmt::format("{}; {} holds the samples; when the problem is fixed, continue with --resume",
                                error.what(), checkpoint.file().string()));
}

/// Read, check, compile, render or merge, develop, write.
void run_phases(const Job& job, base::FileSet& files, JobReport& report) {
  Stopwatch watch, total;
  report.phases.prepare_s = job.prepare_s;
  const std::shared_ptr<PreparedScene> prepared = job.prepared ? job.prepared : std::make_shared<PreparedScene>();
  if (job.keep == nullptr) image::start_loading();
  const load::LoadedScene& loaded = load(job, *prepared, report);
  const format::ReadResult& read = loaded.read;
  const display::Settings& display = loaded.display;
  load::add_scene_files(job.scene.file, read.scene, files);
  report.phases.read_s = watch.lap();
  stop_if_cancelled(job);

  const compile::CompiledScene& compiled = prepared->compile(job.resources.memory_limit);
  check_samples(job, compiled);
  check_sizes(job, compiled);
  const Layers layers = layers_for(job, read.scene, compiled);
  for (const auto& manifest : manifest_files(layers.mattes, job.outputs)) base::check_creatable(manifest);
  const image::Provenance provenance = provenance_of(job, read, compiled, prepared->hashes(), layers);
  const std::string stamp = stamp_of(job, provenance, display, report.display);
  report.scene_hash = provenance.at("sceneHash");
  report.was_skipped = job.skip_existing && is_up_to_date(job, compiled, provenance, stamp);
  if (report.was_skipped) return;
  require_disk_space(job.outputs, is_shard(job), image_size(compiled.width, compiled.height, layers.request),
                     job.resources.disk_limit);
  const MemoryNeeds needs =
      memory_needs(compiled, layers.request, job.sampling.is_adaptive(), prepared->has_accelerator());
  require_memory(estimate_memory(needs), job.resources.memory_limit, held_memory(needs));
  report.hosts = {provenance.at("host")};
  report.width = compiled.width;
  report.height = compiled.height;
  report.spheres = compiled.spheres.size();
  report.phases.compile_s = watch.lap();
  stop_if_cancelled(job);

  const render::Settings settings = settings_of(job, read.scene, layers.request);
  if (job.hooks.on_start && job.merge.shards.empty())
    job.hooks.on_start(
        {job.scene.file.filename().string(), compiled.width, compiled.height, compiled.pixel_aspect, display});
  if (job.keep == nullptr) image::set_threads(settings.threads);  // fails now if the library cannot be loaded
  const auto write_sums = [&](const std::filesystem::path& file, const film::Partial& partial) {
    image::write_partial(file, preview(compiled, partial),
                         picture_header(read, compiled, report, job.outputs.reproducible), provenance, partial);
  };
  const std::filesystem::path checkpoint_path =
      job.keep == nullptr ? checkpoint_file(job.outputs.images.front().path) : std::filesystem::path();
  Checkpoint checkpoint(checkpoint_path, job.checkpoint, job.hooks, provenance, write_sums);
  render::Result result = job.merge.shards.empty()
                              ? render_job(job, *prepared, compiled, settings, checkpoint, total.lap(), report)
                              : merge_job(job, compiled, settings, provenance, report);
  report.render = result.statistics;
  const double made_s = watch.lap();
  if (!job.merge.shards.empty()) report.phases.finish_s = made_s;

  report.target_missed = missed_target(job, result.statistics);
  if (job.denoise && !is_shard(job)) {
    denoise_picture(job, read.scene, settings.threads, result.picture);
    report.phases.denoise_s = watch.lap();
  }
  count_bad_values(result.picture, report);
  if (job.keep != nullptr) {
    keep(job, read, compiled, layers, provenance, display, files, std::move(result.picture), report);
  } else if (is_shard(job)) {
    write_sums(job.outputs.images.front().path, *result.partial);
  } else {
    image::Header header = finished_header(job, read, compiled, report, job.outputs.reproducible);
    header.stamp = stamp;
    const int bits = job.outputs.bits != 0 ? job.outputs.bits : report.display.default_bits();
    try {
      report.written = write_outputs(job.outputs, display, bits, result.picture, header, layers.mattes);
      if (!job.outputs.deep.empty()) image::write_deep(job.outputs.deep, result.deep, result.picture, header);
    } catch (const base::Error& error) {
      if (!result.partial) throw;  // of a merge: the shards still exist
      save_samples(error, *result.partial, checkpoint, report);
    }
  }
  checkpoint.finish(result.partial && job.keep == nullptr ? &*result.partial : nullptr);
  report.phases.write_s = watch.lap();
}

/// True if a failure may be written to the statistics file. It may not if the request is invalid, since the error may
/// concern this very file, nor if the scene reads the file, which is known only after parsing it.
bool may_report(const Job& job, const JobReport& report, const base::Error& error, base::FileSet& files) {
  if (error.kind() == base::ErrorKind::kUsage) return false;
  if (!report.scene_hash.empty()) return true;
  try {
    load::add_named_files(job.scene, {job.scene.frame}, files);
    return true;
  } catch (const base::Error& unreadable) {
    std::error_code ignored;
    return unreadable.kind() != base::ErrorKind::kUsage && !std::filesystem::exists(job.outputs.statistics, ignored);
  }
}

}  // namespace

bool is_limited(const Job& job) { return job.scene.overrides.sets("render.samples"); }

JobReport run_job(const Job& job) {
  base::FileSet own;
  base::FileSet& files = job.files ? *job.files : own;
  if (!job.files) add_job_files(job, own);
  check_request(job);
  JobReport report;
  const base::StopScope scope(job.hooks.cancel);
  try {
    run_phases(job, files, report);
  } catch (const base::Error& error) {
    if (may_report(job, report, error, files)) write_failure(job.outputs.statistics, report, error);
    throw;
  } catch (const std::bad_alloc&) {
    const base::Error error(base::ErrorKind::kNoMemory,
                            "out of memory; orrery info SCENE prints how much a scene needs");
    if (may_report(job, report, error, files)) write_failure(job.outputs.statistics, report, error);
    throw error;
  }
  if (!job.outputs.statistics.empty() && !report.was_skipped) write_statistics(job.outputs.statistics, report, {});
  return report;
}

}  // namespace orrery::job
