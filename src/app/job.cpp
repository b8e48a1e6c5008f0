// SPDX-License-Identifier: Apache-2.0
#include "app/job.h"

#include <chrono>

#include "app/picture_header.h"
#include "app/scene_hash.h"
#include "app/statistics.h"
#include "app/threads.h"
#include "base/atomic_file.h"
#include "base/error.h"
#include "base/suggestion.h"
#include "compile/compile.h"
#include "format/read_scene.h"
#include "image/format.h"
#include "kernel/isa.h"

namespace orrery::app {
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

bool wants_display(const Job& job) {
  for (const auto& output : job.outputs)
    if (image::is_display_format(image::format_of(output))) return true;
  return false;
}

/// Everything that can be known to fail before hours are spent.
void check_outputs(const Job& job) {
  for (const auto& output : job.outputs) {
    const image::Format format = image::format_of(output);
    if (image::is_display_format(format) && job.bits > image::most_bits(format))
      throw base::Error(base::ErrorKind::kUsage, output.string() + " holds 8 bits in a channel; PNG and TIFF hold 16");
    base::check_creatable(output);
  }
  if (!job.statistics.empty()) base::check_creatable(job.statistics);
}

void add(image::WriteReport& sum, const image::WriteReport& one) {
  sum.clamped += one.clamped;
  sum.not_finite += one.not_finite;
}

void write_outputs(const Job& job, const display::Settings& display, const film::Picture& picture,
                   const image::Header& header, JobReport& report) {
  for (const auto& output : job.outputs) {
    switch (image::format_of(output)) {
      case image::Format::kExr: add(report.written, image::write_exr(output, picture, header, job.exr)); break;
      case image::Format::kHdr: add(report.written, image::write_hdr(output, picture)); break;
      case image::Format::kPng:
      case image::Format::kTiff:
      case image::Format::kJpeg:
      case image::Format::kPpm:
        image::write_encoded(output, display::develop(picture, display, job.bits == 0 ? 8 : job.bits),
                             job.reproducible ? "" : header.software);
        break;
    }
  }
}

}  // namespace

JobReport run_job(const Job& job) {
  JobReport report;
  Stopwatch watch;
  check_outputs(job);
  if (!job.isa.empty() && !kernel::limit_isa(job.isa))
    throw base::Error(base::ErrorKind::kUsage, "no instruction set " + job.isa + " here; this processor and program have " +
                                                   base::joined(kernel::available_isas()));

  const format::ReadResult read = format::read_scene(job.scene, job.overrides);
  if (job.on_warning)
    for (const base::Finding& warning : read.warnings) job.on_warning(warning);
  display::Settings display = job.display;
  display.working_space = read.scene.color.space;
  if (wants_display(job)) report.display = display::choose(display);
  report.phases.read_s = watch.lap();

  const compile::World world = compile::compile(read.scene);
  report.scene_hash = scene_hash(world);
  report.width = world.width;
  report.height = world.height;
  report.samples = world.samples;
  report.spheres = world.spheres.size();
  report.phases.compile_s = watch.lap();

  render::Settings settings;
  settings.threads = job.threads > 0 ? job.threads : default_threads();
  settings.on_progress = job.on_progress;
  settings.cancel = job.cancel;
  const render::Result result = render::render(world, settings);
  report.render = result.statistics;
  report.phases.build_s = result.statistics.build_s;
  report.phases.render_s = result.statistics.render_s;
  watch.lap();
  if (!result.completed) {
    if (!job.statistics.empty()) write_statistics(job.statistics, report, "stopped");
    throw base::Error(base::ErrorKind::kStopped, "stopped; no picture was written");
  }

  report.bad_values = film::count_bad_values(result.picture);
  const image::Header header = picture_header(read.scene, world, report, job.reproducible);
  write_outputs(job, display, result.picture, header, report);
  report.phases.write_s = watch.lap();
  if (!job.statistics.empty()) write_statistics(job.statistics, report, "completed");
  return report;
}

}  // namespace orrery::app
