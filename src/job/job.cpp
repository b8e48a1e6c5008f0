// SPDX-License-Identifier: Apache-2.0
#include "job/job.h"

#include <new>
#include <optional>
#include <utility>

#include <fmt/core.h>

#include "annotation/annotate.h"
#include "base/atomic_file.h"
#include "base/stop_point.h"
#include "base/stopwatch.h"
#include "base/text.h"
#include "compile/compiled_scene.h"
#include "denoise/denoise.h"
#include "display/settings.h"
#include "film/layer_planes.h"
#include "film/partial.h"
#include "image/format.h"
#include "image/library.h"
#include "image/partial_file.h"
#include "job/check_job.h"
#include "job/checkpoint.h"
#include "job/layers.h"
#include "job/picture_header.h"
#include "job/prepared_scene.h"
#include "job/rendering.h"
#include "job/shards.h"
#include "job/statistics.h"
#include "job/version.h"
#include "load/load_scene.h"
#include "load/read_scene.h"
#include "render/outlines.h"
#include "render/render.h"
#include "render/result.h"
#include "render/settings.h"
#include "scene/layers.h"
#include "scene/scene.h"

namespace orrery::job {
namespace {

[[noreturn]] void stop_job(const std::string& remedy = "") {
  throw base::Error(base::ErrorKind::kStopped, "stopped; no image was written" + remedy);
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

/// One run of a job. The methods are in the order in which they are first called.
class Run {
 public:
  /// `report`   receives what is known so far, also if the job fails
  Run(const Job& job, base::FileSet& files, JobReport& report)
      : job_(job),
        files_(files),
        report_(report),
        prepared_(job.prepared ? job.prepared : std::make_shared<PreparedScene>()) {}

  void run() {
    prepare("reading");
    load();
    report_.phases.read_s = watch_.lap();
    stop_if_cancelled();

    prepare("compiling");
    compile();
    if (report_.was_skipped) return;
    report_.phases.compile_s = watch_.lap();
    stop_if_cancelled();

    begin();
    render::Result result = is_merge() ? merge() : render();
    finish(result);
    write(result);
    checkpoint_->finish(result.partial && !is_kept() ? &*result.partial : nullptr);
    report_.phases.write_s = watch_.lap();
  }

 private:
  bool is_merge() const { return !job_.merge.shards.empty(); }
  /// True if the image stays in memory, and no file is written.
  bool is_kept() const { return job_.keep != nullptr; }
  const load::LoadedScene& loaded() const { return prepared_->loaded(); }
  const scene::Scene& scene() const { return loaded().read.scene; }
  const compile::CompiledScene& compiled() const { return prepared_->compiled(); }
  bool is_cancelled() const {
    return job_.hooks.cancel != nullptr && job_.hooks.cancel->load(std::memory_order_relaxed);
  }
  void stop_if_cancelled() const {
    if (is_cancelled()) stop_job();
  }
  void warn(const base::Diagnostic& diagnostic) const {
    if (job_.hooks.on_warning) job_.hooks.on_warning(diagnostic);
  }

  void prepare(const char* phase, double fraction = 0) const {
    if (job_.hooks.on_preparation) job_.hooks.on_preparation(phase, fraction);
  }

  /// Reads the scene, and checks it against the output formats.
  void load() {
    report_.phases.prepare_s = job_.prepare_s;
    const bool writes_display_format = job_.outputs.has_display_format();
    load::SceneRequest request{job_.scene, job_.outputs.display, writes_display_format || job_.hooks.develops_pixels};
    request.memory_limit = job_.resources.memory_limit;
    prepared_->load(std::move(request));
    for (const base::Diagnostic& warning : loaded().warnings) warn(warning);
    if (writes_display_format) {
      report_.display = *loaded().choice;
      require_bits(report_.display, job_.outputs);
    }
    load::add_scene_files(job_.scene.file, scene(), files_);
  }

  /// Compiles the scene, and checks everything that can be known before rendering.
  void compile() {
    prepared_->compile(job_.resources.memory_limit);
    check_scene(job_, compiled());
    choose_layers();
    for (const auto& manifest : manifest_files(layers_.mattes, job_.outputs)) base::check_creatable(manifest);
    provenance_ = provenance_of(job_, loaded().read, compiled(), prepared_->hashes(), layers_);
    annotation::LegendColors legend;
    if (scene().annotation.color_bar) legend = annotation::legend_of(scene(), loaded().display.config);
    drawing_ = annotation::drawing_of(scene(), legend, annotated_view());
    if (const std::string missing = annotation::missing_glyphs(drawing_); !missing.empty())
      warn(base::file_diagnostic(
          base::Severity::kWarning, job_.scene.file.string(),
          fmt::format("the font {} has no glyphs for `{}`", drawing_.font.string(), base::printable(missing)),
          "set annotation.font to another font"));
    stamp_ = annotation::stamped(stamp_of(job_, provenance_, loaded().display, report_.display), drawing_);
    report_.scene_hash = provenance_.at("sceneHash");
    report_.was_skipped = job_.skip_existing && is_up_to_date(job_, compiled(), provenance_, stamp_);
    if (report_.was_skipped) return;
    require_disk_space(job_, compiled().width, compiled().height, layers_.request);
    const MemoryEstimate memory =
        estimate_memory(compiled(), layers_.request, job_.sampling.is_adaptive(), prepared_->has_accelerator());
    require_memory(memory, job_.resources.memory_limit, memory.held());
    report_.hosts = {provenance_.at("host")};
    report_.width = compiled().width;
    report_.height = compiled().height;
    report_.spheres = compiled().spheres.size();
    report_.rods = compiled().rod_count();
  }

  /// The layers that an output of the job holds; others are not computed.
  void choose_layers() {
    layers_ = job::choose_layers(scene(), compiled());
    film::LayerRequest& request = layers_.request;
    request.deep = !job_.outputs.deep.empty();
    request.halves = request.halves || job_.denoise;
    image::check_lossless(film::planes_of(request), job_.outputs.exr);
    check_layers(job_, scene());
    if (job_.outputs.has_exr() || is_kept()) return;
    Layers none;
    none.request.coverage = request.coverage;
    none.request.deep = request.deep;
    none.request.halves = job_.denoise;
    layers_ = std::move(none);
  }

  /// The image to annotate.
  annotation::View annotated_view() const {
    const kernel::Camera& camera = compiled().camera;
    const auto project = [&camera](const math::Vec3d& at) -> std::optional<std::pair<double, double>> {
      const auto along = [from = at - camera.origin](const math::Vec3d& axis) {
        return dot(from, axis) / dot(axis, axis);
      };
      const double depth = along(camera.forward), scale = camera.is_orthographic ? 1 : depth;
      if (!(depth > 0)) return {};
      return std::pair{along(camera.right) / scale + camera.half_width,
                       along(camera.down) / scale + camera.half_height};
    };
    return {compiled().width, compiled().height, job_.scene.frame, job_.scene.file.parent_path(), project};
  }

  /// Opens what rendering needs.
  void begin() {
    settings_.threads = thread_count(job_.resources.threads);
    if (scene().render.traversal == scene::Traversal::kPacket) settings_.traversal = accel::Traversal::kPacket;
    if (scene().render.traversal == scene::Traversal::kSingle) settings_.traversal = accel::Traversal::kSingle;
    settings_.layers = layers_.request;
    settings_.on_progress = job_.hooks.on_progress;
    settings_.on_pixels = job_.hooks.on_pixels;
    settings_.cancel = job_.hooks.cancel;
    if (is_kept()) job_.keep->drawing = drawing_;
    if (job_.hooks.on_start && !is_merge())
      job_.hooks.on_start({compiled().width, compiled().height, loaded().display});
    if (!is_kept()) image::set_threads(settings_.threads);  // fails now if the library cannot be loaded
    checkpoint_.emplace(is_kept() ? std::filesystem::path() : checkpoint_file(job_.outputs.images.front().path),
                        job_.checkpoint, job_.hooks, provenance_,
                        [this](const auto& file, const film::Partial& partial) { write_sums(file, partial); });
  }

  /// Renders, resuming from the checkpoint if there is one, and writes a checkpoint if stopped.
  render::Result render() {
    settings_.sampling = job_.sampling;
    settings_.sampling.spend(since_begin_.lap());
    settings_.sampling.unlimited = !is_limited(job_);
    settings_.snapshot_is_due = [&] { return checkpoint_->is_due(); };
    settings_.on_snapshot = [&](const film::Partial& partial) { checkpoint_->write_snapshot(partial); };
    std::optional<film::Partial> from = checkpoint_->load(compiled().width, compiled().height);
    report_.was_resumed = from.has_value();
    if (from && !is_of_this_render(*from))
      throw base::Error(base::ErrorKind::kBadData,
                        checkpoint_->file().string() +
                            " contains sums that do not match its header; delete it, or render "
                            "without --resume to start again");
    accel::Accel* const accel = build();
    settings_.sampling.spend(report_.phases.build_s);
    render::Result result;
    if (accel != nullptr) result = render::render(compiled(), *accel, settings_, std::move(from));
    report_.render = result.statistics;
    report_.phases.render_s = result.statistics.render_s;
    report_.phases.finish_s = result.statistics.finish_s;
    if (!result.completed) stop(result);
    watch_.lap();
    return result;
  }

  /// True if a render can continue from these sums; they may differ from their header if the file is damaged.
  bool is_of_this_render(const film::Partial& from) const {
    const film::Partial fresh(from.width, from.height, settings_.layers, settings_.sampling.is_adaptive());
    return from.is_adaptive() == fresh.is_adaptive() && from.has_arrays_of(fresh) &&
           from.has_known_spheres(compiled().object_materials.size());
  }

  /// Builds the BVH, unless the prepared scene has one.
  ///
  /// Result     null if the job was cancelled meanwhile
  accel::Accel* build() {
    const bool is_built = prepared_->has_accelerator();
    base::Stopwatch watch;
    accel::Accel* accel = nullptr;
    try {
      accel = &prepared_->accelerator(settings_.threads, [this](double fraction) {
        prepare("building", fraction);
        return !is_cancelled();
      });
    } catch (const base::Error& error) {
      if (error.kind() != base::ErrorKind::kStopped) throw;
    }
    if (!is_built) report_.phases.build_s = watch.lap();
    return accel;
  }

  /// Ends a cancelled job; its samples go to a checkpoint.
  [[noreturn]] void stop(const render::Result& result) {
    const std::string file = checkpoint_->file().string();
    if (!result.partial || is_kept())
      stop_job(report_.was_resumed ? fmt::format("; {} still holds the samples of the earlier run", file) : "");
    checkpoint_->write(*result.partial);
    report_.checkpoint = checkpoint_->file();
    stop_job(fmt::format("; {} holds the samples so far; continue with --resume", file));
  }

  render::Result merge() {
    render::Result result = merge_shards(job_, compiled(), settings_, provenance_, report_);
    report_.phases.finish_s = watch_.lap();
    return result;
  }

  /// Denoises the image, and counts bad values before a display transform can hide them.
  void finish(render::Result& result) {
    report_.render = result.statistics;
    report_.target_missed = missed_target(job_, result.statistics);
    if (job_.is_strict && !report_.target_missed.empty()) report_.exit_status = kTargetMissed;
    if (job_.denoise && !is_shard(job_)) {
      denoise_picture(result.picture);
      report_.phases.denoise_s = watch_.lap();
    }
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

  /// Denoises the image, and removes the halves unless the scene requests them.
  void denoise_picture(film::Picture& picture) const {
    const bool keeps_halves = base::contains(scene::requested_layers(scene()), scene::kHalvesLayer);
    if (!denoise::denoise(picture, settings_.threads, keeps_halves).missing.empty())
      warn(base::file_diagnostic(base::Severity::kWarning, job_.scene.file.string(),
                                 "the noise cannot be measured, because one half of the samples is missing; the image "
                                 "is hardly denoised",
                                 "render at least 2 samples per pixel"));
    if (job_.hooks.on_denoised) job_.hooks.on_denoised(picture);
  }

  void write(render::Result& result) {
    if (!is_shard(job_)) annotate(result.picture);
    if (is_kept()) return keep(std::move(result.picture));
    if (is_shard(job_)) {
      if (job_.outputs.reproducible) result.partial->work.seconds = 0;
      return write_sums(job_.outputs.images.front().path, *result.partial);
    }
    image::Header own = header(job_.outputs.reproducible);
    own.stamp = report_.target_missed.empty() ? stamp_ : stamp_of_missed(stamp_);
    try {
      report_.written = write_outputs(job_.outputs, loaded().display, report_.display,
                                      {result.picture, own, layers_.mattes, drawing_});
      if (!job_.outputs.deep.empty()) image::write_deep(job_.outputs.deep, result.deep, result.picture, own);
    } catch (const base::Error& error) {
      if (!result.partial) throw;  // of a merge: the shards still exist
      save_samples(error, *result.partial);
    }
  }

  /// Completes the drawing over the image, and adds it to EXR files as a layer.
  void annotate(film::Picture& picture) {
    if (drawing_.is_empty()) return;
    if (drawing_.outline_px > 0)
      if (accel::Accel* const accel = build(); accel != nullptr)
        drawing_.lines = render::outlines(compiled(), *accel, drawing_.outline_px, settings_.threads);
    if (job_.outputs.has_exr() || is_kept())
      annotation::add_layer(annotation::draw(drawing_, std::identity()), picture);
  }

  /// Keeps the image in memory.
  void keep(film::Picture picture) const {
    Rendering& out = *job_.keep;
    out.job = job_;
    out.job.hooks = {};
    out.job.keep = nullptr;
    out.job.scene.open_data = {};
    out.picture = std::move(picture);
    out.header = header(false);
    out.reproducible_header = header(true);
    out.mattes = layers_.mattes;
    out.drawing = drawing_;
    out.display = loaded().display;
    out.provenance = provenance_;
    out.report = report_;
    out.files = files_;
  }

  /// The header of the finished image.
  image::Header header(bool reproducible) const {
    image::Header out = picture_header(loaded().read, compiled(), report_, reproducible);
    if (job_.denoise) out.attributes.push_back({denoise::kAttribute, "orrery " + program_version()});
    return out;
  }

  /// Writes a shard or a checkpoint, with the beauty as a preview.
  void write_sums(const std::filesystem::path& file, const film::Partial& partial) const {
    image::write_partial(file, render::finished(compiled(), {}, partial, 1).picture,
                         picture_header(loaded().read, compiled(), report_, job_.outputs.reproducible), provenance_,
                         partial);
  }

  /// Ends a job whose image could not be written: writes a checkpoint, so that the samples are not lost.
  [[noreturn]] void save_samples(const base::Error& error, const film::Partial& partial) {
    const std::string file = checkpoint_->file().string();
    try {
      checkpoint_->write(partial);
    } catch (const base::Error& also) {
      throw base::Error(error.kind(),
                        fmt::format("{}; the checkpoint cannot be written, either: {}", error.what(), also.what()));
    }
    report_.checkpoint = checkpoint_->file();
    throw base::Error(
        error.kind(),
        fmt::format("{}; {} holds the samples; when the problem is fixed, continue with --resume", error.what(), file));
  }

  const Job& job_;
  base::FileSet& files_;
  JobReport& report_;
  std::shared_ptr<PreparedScene> prepared_;
  Layers layers_;
  image::Provenance provenance_;  ///< what the sums depend on
  std::string stamp_;             ///< what the images depend on
  annotation::Drawing drawing_;   ///< over the image
  render::Settings settings_;
  std::optional<Checkpoint> checkpoint_;
  base::Stopwatch watch_;  ///< of the phases
  base::Stopwatch since_begin_;
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

}  // namespace

bool is_limited(const Job& job) { return job.scene.overrides.sets("render.samples"); }

JobReport run_job(const Job& job) {
  base::FileSet own;
  base::FileSet& files = job.files ? *job.files : own;
  if (!job.files) add_job_files(job, own);
  check_request(job);
  JobReport report;
  const base::StopScope scope(job.hooks.cancel);
  const auto run = [&] {
    try {
      Run(job, files, report).run();
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
  if (!job.outputs.statistics.empty() && !report.was_skipped) write_statistics(job.outputs.statistics, report);
  return report;
}

}  // namespace orrery::job
