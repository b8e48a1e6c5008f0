// SPDX-License-Identifier: Apache-2.0
#include "cli/render_report.h"

#include "base/text.h"

namespace orrery::cli {
namespace {

using base::append;

void add_bad_values(std::string& out, const job::JobReport& report) {
  const auto tell = [&out](std::uint64_t count, const char* what) {
    if (count > 0) append(out, "warning: %llu %s\n", static_cast<unsigned long long>(count), what);
  };
  tell(report.render.bad_samples, "samples were not finite and were left out of their pixels");
  for (const auto& [layer, bad] : report.bad_layers) {
    const auto tell_of = [&, &name = layer](std::uint64_t count, const char* what) {
      if (count > 0)
        append(out, "warning: %s: %llu values are %s\n", name.c_str(), static_cast<unsigned long long>(count), what);
    };
    tell_of(bad.nan, "not a number");
    tell_of(bad.infinite, "infinite");
    tell_of(bad.negative, "negative");
  }
  if (!report.missing.empty()) append(out, "warning: %s are missing\n", report.missing.c_str());
  tell(report.written.not_finite, "values that are not finite were written as 0");
  tell(report.written.clamped, "values do not fit into their file and were clamped; EXR with --type float keeps them");
}

void add_summary(std::string& out, const job::Job& job, const job::JobReport& report, bool verbose) {
  std::string files;
  for (const job::ImageFile& output : job.outputs.images) files += (files.empty() ? "" : ", ") + output.path.string();
  const double seconds = report.render.render_s;
  const double pixels = static_cast<double>(report.width) * report.height;
  append(out, "wrote %s: %d x %d, %.5g samples per pixel in %.1f s, %.2f M samples/s", files.c_str(), report.width,
         report.height, static_cast<double>(report.render.paths) / pixels, seconds,
         seconds > 0 ? static_cast<double>(report.render.paths) / seconds / 1e6 : 0.0);
  if (report.render.noise)
    append(out, "; noise %.3g, %llu to %llu samples", *report.render.noise,
           static_cast<unsigned long long>(report.render.fewest_samples),
           static_cast<unsigned long long>(report.render.most_samples));
  out += '\n';
  if (!verbose) return;
  if (report.render.accelerator.empty()) return;  // joined
  append(out, "%zu spheres, %s, %s, traversal %s, %d threads, %llu rays; scene %s\n", report.spheres,
         report.render.accelerator.c_str(), report.render.isa.c_str(), report.render.traversal.c_str(),
         report.render.threads, static_cast<unsigned long long>(report.render.rays), report.scene_hash.c_str());
  const job::Phases& phases = report.phases;
  append(out, "read %.3f s, compile %.3f s, build %.3f s, render %.3f s, finish %.3f s, write %.3f s\n", phases.read_s,
         phases.compile_s, phases.build_s, phases.render_s, phases.finish_s, phases.write_s);
  const display::Choice& display = report.display;
  if (!display.display.empty())
    append(out, "display %s, view %s, OCIO config %s\n", display.display.c_str(), display.view.c_str(),
           display.config.c_str());
}

}  // namespace

std::string report_text(const job::Job& job, const job::JobReport& report, bool verbose) {
  std::string out;
  add_bad_values(out, report);
  add_summary(out, job, report, verbose);
  return out;
}

}  // namespace orrery::cli
