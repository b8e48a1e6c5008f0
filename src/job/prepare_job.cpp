// SPDX-License-Identifier: Apache-2.0
#include "job/prepare_job.h"

#include <optional>
#include <utility>

#include <fmt/core.h>

#include "annotation/annotate.h"
#include "base/error.h"
#include "base/text.h"
#include "compile/camera_basis.h"
#include "film/layer_planes.h"
#include "film/motion_vectors.h"
#include "job/check_job.h"
#include "job/checkpoint.h"
#include "job/resources.h"
#include "load/read_scene.h"

namespace orrery::job {
namespace {

/// Reads the scene, and checks it against the output formats.
void load(const PreparedJob& own, base::FileSet& files, JobReport& report) {
  const Job& job = own.job;
  const bool writes_display_format = job.outputs.has_display_format();
  load::SceneRequest request{job.scene, writes_display_format || job.hooks.develops_pixels};
  request.memory_limit = job.resources.memory_limit;
  own.prepared->load(std::move(request));
  for (const base::Diagnostic& warning : own.loaded().warnings) job.hooks.warn(warning);
  if (writes_display_format) {
    report.display = *own.loaded().choice;
    require_bits(report.display, job.outputs);
  }
  load::add_scene_files(job.scene.file, own.scene(), files);
}

/// The layers that an output of the job holds; others are not computed.
Layers layers_of(const PreparedJob& own) {
  const Job& job = own.job;
  // The view that will be applied to an EXR file is not known.
  const bool may_have_looks = job.outputs.has_exr() || (own.loaded().choice && own.loaded().choice->has_looks);
  Layers out = choose_layers(own.scene(), own.compiled(), may_have_looks);
  out.request.deep = !job.outputs.deep.empty();
  out.request.halves = out.request.halves || job.denoise;
  if (out.request.vector) out.request.neighbors = own.prepared->neighbors();
  image::check_lossless(film::planes_of(out.request), job.outputs.exr);
  check_layers(job, own.scene());
  if (job.outputs.has_exr() || job.is_in_memory()) return out;
  Layers none;
  none.request.coverage = out.request.coverage;
  none.request.transparent = out.request.transparent;
  none.request.deep = out.request.deep;
  none.request.halves = job.denoise;
  return none;
}

/// The image to annotate.
annotation::View annotated_view(const PreparedJob& own) {
  const compile::CompiledScene& compiled = own.compiled();
  const auto project = [&camera = compiled.camera](const math::Vec3d& at) -> std::optional<std::pair<double, double>> {
    const std::optional<film::FilmPlace> place = film::film_place(camera, at - camera.origin);
    if (!place) return {};
    return std::pair{place->x + camera.half_width, place->y + camera.half_height};
  };
  return {compiled.width, compiled.height, own.job.scene.frame, own.job.scene.file.parent_path(), project};
}

annotation::Drawing drawing_of(const PreparedJob& own) {
  annotation::LegendColors legend;
  if (own.scene().annotation.color_bar) legend = annotation::legend_of(own.scene(), own.loaded().display.config);
  annotation::Drawing out = annotation::drawing_of(own.scene(), legend, annotated_view(own));
  if (const std::string missing = annotation::missing_glyphs(out); !missing.empty())
    own.job.hooks.warn(base::file_diagnostic(
        base::Severity::kWarning, own.job.scene.file.string(),
        fmt::format("the font {} has no glyphs for `{}`", out.font.string(), base::printable(missing)),
        "set annotation.font to another font"));
  return out;
}

/// Checks that a render fits into memory and on the disk.
void require_resources(const PreparedJob& own) {
  const compile::CompiledScene& compiled = own.compiled();
  const Job& job = own.job;
  require_disk_space(job, compiled.width, compiled.height, own.layers.request);
  require_memory(compiled, own.layers.request,
                 {.is_adaptive = job.settings.is_adaptive(),
                  .has_accelerator = own.prepared->has_accelerator(),
                  .keeps_sums = keeps_sums(job)},
                 job.resources.memory_limit, thread_count(job.resources.threads));
}

void stop_if_cancelled(const Job& job) {
  if (job.hooks.is_cancelled()) stop_job();
}

}  // namespace

void stop_job(const std::string& remedy) {
  throw base::Error(base::ErrorKind::kStopped, "stopped; no image was written" + remedy);
}

PreparedJob prepare_job(const Job& job, base::FileSet& files, JobReport& report, base::Stopwatch& watch) {
  PreparedJob out{job, job.prepared ? job.prepared : std::make_shared<PreparedScene>(), {}, {}, {}, {}};
  report.phases.prepare_s = job.prepare_s;
  job.hooks.prepare("reading");
  load(out, files, report);
  report.phases.read_s = watch.lap();
  stop_if_cancelled(job);

  job.hooks.prepare("compiling");
  const compile::CompiledScene& compiled = out.prepared->compile(job.resources.memory_limit);
  check_scene(job, compiled);
  out.layers = layers_of(out);
  out.provenance = provenance_of(job, out.loaded().read, compiled, out.prepared->hashes(), out.layers);
  out.drawing = drawing_of(out);
  out.stamp = annotation::stamped(stamp_of(job, out.provenance, out.loaded().display, report.display), out.drawing);
  report.scene_hash = out.provenance.at("sceneHash");
  report.was_skipped = job.skip_existing && is_up_to_date(job, compiled, out.provenance, out.stamp);
  if (report.was_skipped) return out;
  require_resources(out);
  report.hosts = {out.provenance.at("host")};
  report.width = compiled.width;
  report.height = compiled.height;
  report.spheres = compiled.spheres.size();
  report.rods = compiled.rod_count();
  report.phases.compile_s = watch.lap();
  stop_if_cancelled(job);
  return out;
}

}  // namespace orrery::job
