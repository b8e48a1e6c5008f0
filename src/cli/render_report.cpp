// SPDX-License-Identifier: Apache-2.0
#include "cli/render_report.h"

#include <fmt/core.h>

#include "base/diagnostic.h"
#include "display/settings.h"
#include "job/job.h"
#include "job/job_report.h"

namespace orrery::cli {
namespace {

void add_bad_values(std::string& out, const job::JobReport& report) {
  const auto warn = [&out](std::uint64_t count, const char* what) {
    if (count > 0) out += base::warning_line(fmt::format("{} {}", count, what));
  };
  warn(report.render.bad_samples, "samples were not finite and were excluded from their pixels");
  for (const auto& [layer, bad] : report.bad_layers) {
    const auto warn_of = [&, &name = layer](std::uint64_t count, const char* what) {
      if (count > 0) out += base::warning_line(fmt::format("{}: {} values are {}", name, count, what));
    };
    warn_of(bad.nan, "not a number");
    warn_of(bad.infinite, "infinite");
    warn_of(bad.negative, "negative");
  }
  if (!report.missing.empty()) out += base::warning_line(fmt::format("{} are missing", report.missing));
  warn(report.written.not_finite, "values that are not finite were written as 0");
  warn(report.written.clamped,
       "values exceed the range of their file and were clamped; EXR with --type float keeps them");
}

void add_summary(std::string& out, const job::Job& job, const job::JobReport& report, ReportDetail detail) {
  std::string files;
  for (const job::ImageFile& output : job.outputs.images) files += (files.empty() ? "" : ", ") + output.path.string();
  const double pixels = static_cast<double>(report.width) * report.height;
  const render::Statistics& r = report.render;
  out += fmt::format("wrote {}: {} x {}, {:.5g} samples per pixel in {:.1f} s, {:.2f} M samples/s", files, report.width,
                     report.height, static_cast<double>(r.paths) / pixels, r.render_s,
                     r.render_s > 0 ? static_cast<double>(r.paths) / r.render_s / 1e6 : 0.0);
  if (r.noise) out += fmt::format("; noise {:.3g}, {} to {} samples", *r.noise, r.min_samples, r.max_samples);
  if (detail.has_total) out += fmt::format("; {:.1f} s in all", report.phases.total_s());
  out += '\n';
  if (!detail.is_verbose) return;
  if (r.accelerator.empty()) return;  // a merge
  out += fmt::format("{} spheres, {}, {}, traversal {}, {} threads, {} rays; scene {}\n", report.spheres, r.accelerator,
                     r.isa, r.traversal, r.threads, r.rays, report.scene_hash);
  const job::Phases& p = report.phases;
  if (p.prepare_s > 0) out += fmt::format("prepare {:.3f} s\n", p.prepare_s);
  if (p.denoise_s > 0) out += fmt::format("denoise {:.3f} s\n", p.denoise_s);
  out +=
      fmt::format("read {:.3f} s, compile {:.3f} s, build {:.3f} s, render {:.3f} s, finish {:.3f} s, write {:.3f} s\n",
                  p.read_s, p.compile_s, p.build_s, p.render_s, p.finish_s, p.write_s);
  const display::Choice& display = report.display;
  if (!display.display.empty())
    out += fmt::format("display {}, view {}, OCIO config {}\n", display.display, display.view, display.config);
}

}  // namespace

std::string report_text(const job::Job& job, const job::JobReport& report, ReportDetail detail) {
  std::string out;
  add_bad_values(out, report);
  add_summary(out, job, report, detail);
  return out;
}

}  // namespace orrery::cli
