// SPDX-License-Identifier: Apache-2.0
#include "job/run_job.h"

#include <algorithm>
#include <new>
#include <optional>
#include <utility>

#include <fmt/core.h>

#include "annotation/annotate.h"
#include "base/file_set.h"
#include "base/stop_point.h"
#include "base/stopwatch.h"
#include "base/text.h"
#include "denoise/denoise.h"
#include "film/sums.h"
#include "image/library.h"
#include "image/sums_file.h"
#include "job/check_job.h"
#include "job/checkpoint.h"
#include "job/picture_header.h"
#include "job/prepare_job.h"
#include "job/resources.h"
#include "job/shards.h"
#include "job/statistics.h"
#include "job/version.h"
#include "job/write_outputs.h"
#include "load/read_scene.h"
#include "render/outlines.h"
#include "render/render.h"
#include "render/result.h"
#include "render/settings.h"
#include "scene/layers.h"

namespace orrery::job {
namespace {

std::string missed_target(const Job& job, const render::Statistics& statistics) {
  std::string out;
  const bool ended_by_time = statistics.ended_by == "time";
  if (job.settings.noise > 0 && statistics.noise && *statistics.noise > job.settings.noise)
    out = fmt::format("noise {:.3g} instead of {:.3g}: {}", *statistics.noise, job.settings.noise,
                      ended_by_time ? "the time budget ended" : "the pixels that need more samples reached the limit");
  if (job.settings.noise > 0 && statistics.unreliable_pixels > 0)
    out +=
        fmt::format("{}the noise of {} pixels cannot be estimated: too few paths found light near them; allow more {}",
                    out.empty() ? "" : "; ", statistics.unreliable_pixels, ended_by_time ? "time" : "samples");
  return out;
}

/// Time budget of a job that has spent its own before the first sample, seconds; 0 would be none.
constexpr double kShortestBudget = 1e-3;

/// One run of a job: four flows, over steps that are in the order in which they are first called.
class Run {
 public:
  /// Prepares the job.
  ///
  /// `report`   receives what is known so far, also if the job fails
  Run(const Job& job, base::FileSet& files, JobReport& report)
      : job_(job),
        report_(report),
        own_(prepare_job(job, files, report, watch_)),
        threads_(thread_count(job.resources.threads)) {}

  /// Writes the files that the job requests.
  void write_files() {
    image::set_threads(threads_);  // fails now if the library cannot be loaded
    if (!job_.merge.shards.empty())
      merge();
    else if (is_shard(job_))
      render_shard();
    else
      render_images();
    report_.phases.write_s = watch_.lap();
  }

  /// Renders, and keeps what is needed to write the image.
  Rendering render_in_memory(const base::FileSet& files) {
    render::Result result = render(nullptr);
    finish(result);
    Rendering out;
    out.job = job_;
    out.job.hooks = {};
    out.job.scene.open_data = {};
    out.picture = std::move(result.picture);
    out.header = header(false);
    out.reproducible_header = header(true);
    out.drawing = own_.drawing;
    out.display = own_.loaded().display;
    out.provenance = own_.provenance;
    out.report = report_;
    out.files = files;
    return out;
  }

 private:
  void merge() {
    render::Result result = merge_shards(own_, threads_, report_);
    report_.phases.finish_s = watch_.lap();
    const base::StopScope scope(nullptr);
    finish(result);
    write_images(result);
  }

  void render_shard() {
    Checkpoint checkpoint = open_checkpoint();
    render::Result result = render(&checkpoint);
    report_result(result);
    if (job_.outputs.reproducible) result.sums->work.seconds = 0;
    write_sums(job_.outputs.images.front().path, *result.sums);
    checkpoint.finish(result.sums);
  }

  void render_images() {
    Checkpoint checkpoint = open_checkpoint();
    render::Result result = render(&checkpoint);
    const base::StopScope scope(nullptr);  // an image whose samples are complete is finished
    finish(result);
    try {
      write_images(result);
    } catch (const base::Error& error) {
      if (!result.sums) throw;
      save_samples(error, checkpoint, *result.sums);
    }
    checkpoint.finish(result.sums);
  }

  const compile::CompiledScene& compiled() const { return own_.compiled(); }

  Checkpoint open_checkpoint() const {
    return {job_, own_.provenance, [this](const auto& file, const film::Sums& sums) { write_sums(file, sums); }};
  }

  /// Writes a shard or a checkpoint, with the beauty as a preview.
  void write_sums(const std::filesystem::path& file, const film::Sums& sums) const {
    image::write_sums(file, render::finished(compiled(), {}, sums, 1).picture,
                      picture_header(own_.loaded().read, compiled(), report_, job_.outputs.reproducible),
                      own_.provenance, sums);
  }

  /// Renders. Resumes from the checkpoint if there is one, and writes it if stopped; null: no checkpoint.
  render::Result render(Checkpoint* checkpoint) {
    if (job_.hooks.on_start)
      job_.hooks.on_start({compiled().width, compiled().height, own_.loaded().display}, own_.drawing);
    render::Settings settings = render_settings();
    std::optional<film::Sums> from;
    if (checkpoint != nullptr) {
      settings.checkpoint_is_due = [&] { return checkpoint->is_due(); };
      settings.on_checkpoint = [&](const film::Sums& sums) { checkpoint->try_write(sums); };
      from = checkpoint->load(compiled().width, compiled().height);
      if (from) require_same_render(*from, settings, checkpoint->file());
    }
    report_.was_resumed = from.has_value();
    accel::Accel* const accel = build();
    if (settings.time_budget_s > 0)
      settings.time_budget_s = std::max(settings.time_budget_s - since_begin_.seconds(), kShortestBudget);
    const base::StopScope scope(checkpoint == nullptr ? job_.hooks.cancel : nullptr);  // a checkpoint needs the samples
    render::Result result;
    if (accel != nullptr) result = render::render(compiled(), *accel, settings, std::move(from));
    report_.render = result.statistics;
    report_.phases.render_s = result.statistics.render_s;
    report_.phases.finish_s = result.statistics.finish_s;
    if (!result.completed) stop(result, checkpoint);
    watch_.lap();
    return result;
  }

  render::Settings render_settings() {
    render::Settings out = job_.settings;
    out.threads = threads_;
    const scene::Traversal traversal = own_.scene().render.traversal;
    if (traversal == scene::Traversal::kPacket) out.traversal = accel::Traversal::kPacket;
    if (traversal == scene::Traversal::kSingle) out.traversal = accel::Traversal::kSingle;
    out.layers = own_.layers.request;
    out.unlimited = !is_limited(job_);
    out.keeps_sums = keeps_sums(job_);
    out.on_progress = job_.hooks.on_progress;
    out.on_pixels = job_.hooks.on_pixels;
    out.cancel = job_.hooks.cancel;
    return out;
  }

  /// Requires that a render can continue from these sums; they may differ from their header if the file is damaged.
  void require_same_render(const film::Sums& from, const render::Settings& settings,
                           const std::filesystem::path& file) const {
    const film::Sums fresh(from.width, from.height, settings.layers, settings.is_adaptive());
    if (from.is_adaptive() == fresh.is_adaptive() && from.has_arrays_of(fresh) &&
        from.has_known_spheres(compiled().object_materials.size()))
      return;
    throw base::Error(base::ErrorKind::kBadData, file.string() +
                                                     " contains sums that do not match its header; delete it, or "
                                                     "render without --resume to start again");
  }

  /// Builds the BVH, unless the prepared scene has one.
  ///
  /// Result     null if the job was cancelled meanwhile
  accel::Accel* build() {
    const bool is_built = own_.prepared->has_accelerator();
    base::Stopwatch watch;
    accel::Accel* accel = nullptr;
    try {
      accel = &own_.prepared->accelerator(threads_, [this](double fraction) {
        job_.hooks.prepare("building", fraction);
        return !job_.hooks.is_cancelled();
      });
    } catch (const base::Error& error) {
      if (error.kind() != base::ErrorKind::kStopped) throw;
    }
    if (!is_built) report_.phases.build_s = watch.lap();
    return accel;
  }

  /// Ends a cancelled job; its samples go to a checkpoint.
  [[noreturn]] void stop(const render::Result& result, Checkpoint* checkpoint) {
    if (checkpoint == nullptr) stop_job();
    const std::string file = checkpoint->file().string();
    if (!result.sums)
      stop_job(report_.was_resumed ? fmt::format("; {} still holds the samples of the earlier run", file) : "");
    checkpoint->write(*result.sums);
    report_.checkpoint = checkpoint->file();
    stop_job(fmt::format("; {} holds the samples so far; continue with --resume", file));
  }

  /// Denoises the image, counts its bad values before a display transform can hide them, and annotates it.
  void finish(render::Result& result) {
    if (job_.denoise) {
      denoise_picture(result.picture);
      report_.phases.denoise_s = watch_.lap();
    }
    report_result(result);
    film::Picture& picture = result.picture;
    if (job_.outputs.has_exr() && !picture.coverage.empty() && !picture.is_transparent)
      picture.planes.push_back({film::kCoverageChannel, picture.coverage, film::PlaneKind::kData});
    annotate(picture);
  }

  /// Denoises the image, and removes the halves unless the scene requests them.
  void denoise_picture(film::Picture& picture) const {
    const bool keeps_halves = base::contains(scene::requested_layers(own_.scene()), scene::kHalvesLayer);
    if (!denoise::denoise(picture, threads_, keeps_halves).is_filtered)
      job_.hooks.warn(base::file_diagnostic(
          base::Severity::kWarning, job_.scene.file.string(),
          "the noise cannot be measured, because one half of the samples is missing; the image is not denoised",
          "render at least 2 samples per pixel"));
    if (job_.hooks.on_denoised) job_.hooks.on_denoised(picture);
  }

  void report_result(const render::Result& result) {
    report_.render = result.statistics;
    report_.target_missed = missed_target(job_, result.statistics);
    if (job_.is_strict && !report_.target_missed.empty()) report_.exit_status = kTargetMissed;
    for (const film::Plane& plane : result.picture.planes) {
      if (film::is_half(plane.name)) continue;  // NaN without samples
      const film::BadValues bad = film::count_bad_values(plane);
      if (!bad.any()) continue;
      report_.bad_values += bad;
      const std::string layer = plane.layer().empty() ? "beauty" : plane.layer();
      auto& layers = report_.bad_layers;
      if (layers.empty() || layers.back().first != layer) layers.push_back({layer, {}});
      layers.back().second += bad;
    }
  }

  /// Completes the drawing over the image, and adds it to EXR files as a layer.
  void annotate(film::Picture& picture) {
    annotation::Drawing& drawing = own_.drawing;
    if (drawing.is_empty()) return;
    if (drawing.outline_px > 0)
      if (const accel::Accel* const accel = build(); accel != nullptr) {
        render::OutlineStyle style{drawing.outline_px, drawing.outline_depth, {}};
        if (drawing.outline_objects) style.groups = object_classes(own_.scene(), compiled());
        drawing.lines = render::outlines(compiled(), *accel, style, threads_);
      }
    if (job_.outputs.has_exr() || job_.is_in_memory())
      annotation::add_layer(annotation::draw(drawing, std::identity()), picture);
  }

  void write_images(const render::Result& result) {
    image::Header own = header(job_.outputs.reproducible);
    own.stamp = report_.target_missed.empty() ? own_.stamp : stamp_of_missed(own_.stamp);
    report_.written =
        write_outputs(job_.outputs, own_.loaded().display, report_.display, result.picture, own, own_.drawing);
    if (!job_.outputs.deep.empty()) image::write_deep(job_.outputs.deep, result.deep, result.picture, own);
  }

  /// The header of the finished image.
  image::Header header(bool reproducible) const {
    image::Header out = picture_header(own_.loaded().read, compiled(), report_, reproducible);
    out.matte_attributes = matte_attributes(own_.layers.mattes);
    if (job_.denoise) out.attributes.push_back({denoise::kAttribute, "orrery " + program_version()});
    return out;
  }

  /// Ends a job whose image could not be written: writes a checkpoint, so that the samples are not lost.
  [[noreturn]] void save_samples(const base::Error& error, Checkpoint& checkpoint, const film::Sums& sums) {
    const std::string file = checkpoint.file().string();
    try {
      checkpoint.write(sums);
    } catch (const base::Error& also) {
      throw base::Error(error.kind(),
                        fmt::format("{}; the checkpoint cannot be written, either: {}", error.what(), also.what()));
    }
    report_.checkpoint = checkpoint.file();
    throw base::Error(
        error.kind(),
        fmt::format("{}; {} holds the samples; when the problem is fixed, continue with --resume", error.what(), file));
  }

  const Job& job_;
  JobReport& report_;
  base::Stopwatch since_begin_;
  base::Stopwatch watch_;  ///< of the phases
  PreparedJob own_;
  int threads_;
};

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

/// Checks a job, then calls `flow(files, report)`, and writes the statistics of a failure.
template <class Flow>
JobReport checked(const Job& job, Flow flow) {
  base::FileSet own;
  base::FileSet& files = job.files ? *job.files : own;
  if (!job.files) add_job_files(job, own);
  check_request(job);
  JobReport report;
  const base::StopScope scope(job.hooks.cancel);
  const auto run = [&] {
    try {
      flow(files, report);
    } catch (const std::bad_alloc&) {
      throw base::Error(base::ErrorKind::kNoMemory, "out of memory; orrery info SCENE prints how much a scene needs");
    }
  };
  try {
    run();
  } catch (const base::Error& error) {
    if (may_report(job, report, error, files)) write_failure(job.outputs.statistics, report, error);
    throw;
  }
  return report;
}

}  // namespace

JobReport run_job(const Job& job) {
  const JobReport report = checked(job, [&job](base::FileSet& files, JobReport& known) {
    Run run(job, files, known);
    if (!known.was_skipped) run.write_files();
  });
  if (!job.outputs.statistics.empty() && !report.was_skipped) write_statistics(job.outputs.statistics, report);
  return report;
}

Rendering render_in_memory(const Job& job) {
  Rendering out;
  checked(job, [&](base::FileSet& files, JobReport& known) { out = Run(job, files, known).render_in_memory(files); });
  return out;
}

}  // namespace orrery::job
