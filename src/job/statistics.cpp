// SPDX-License-Identifier: Apache-2.0
#include "job/statistics.h"

#include <sys/resource.h>

#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "film/picture.h"
#include "job/report_text.h"
#include "job/version.h"

namespace orrery::job {
namespace {

/// Peak resident memory of this process, in bytes.
std::size_t peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;  // Linux reports KiB
}

nlohmann::json bad_values_json(const film::BadValues& bad) {
  return {{"nan", bad.nan}, {"infinite", bad.infinite}, {"negative", bad.negative}, {"above_half", bad.above_half}};
}

}  // namespace

std::string statistics_json(const JobReport& report, const base::Error* error) {
  using nlohmann::json;
  const render::Statistics& r = report.render;
  const auto per_second = [&](std::uint64_t n) { return r.render_s > 0 ? static_cast<double>(n) / r.render_s : 0.0; };
  const char* const reason = error == nullptr                             ? "completed"
                             : error->kind() == base::ErrorKind::kStopped ? "stopped"
                                                                          : "failed";
  const double pixels = static_cast<double>(report.width) * report.height;
  json versions = {{"orrery", program_version()}};
  for (const auto& [name, version] : library_versions()) versions[name] = version;
  json out = {{"schema", "orrery.stats/1"},
              {"exit_reason", reason},
              {"exit_status", error != nullptr ? base::exit_status(error->kind()) : report.exit_status},
              {"scene_hash", report.scene_hash},
              {"width", report.width},
              {"height", report.height},
              {"samples", pixels > 0 ? static_cast<double>(r.paths) / pixels : 0.0},
              {"samples_fewest", r.min_samples},
              {"samples_most", r.max_samples},
              {"noise", json_or_null(r.noise)},
              {"noise_expected", json_or_null(r.expected_noise)},
              {"unreliable_pixels", r.unreliable_pixels},
              {"ended_by", r.ended_by},
              {"target_missed", report.target_missed},
              {"missing", report.missing},
              {"resumed", report.was_resumed},
              {"checkpoint", report.checkpoint.string()},
              {"hosts", report.hosts},
              {"spheres", report.spheres},
              {"rods", report.rods},
              {"paths", r.paths},
              {"rays", r.rays},
              {"paths_per_second", per_second(r.paths)},
              {"rays_per_second", per_second(r.rays)},
              {"seconds",
               {{"prepare", report.phases.prepare_s},
                {"read", report.phases.read_s},
                {"compile", report.phases.compile_s},
                {"build", report.phases.build_s},
                {"render", report.phases.render_s},
                {"finish", report.phases.finish_s},
                {"denoise", report.phases.denoise_s},
                {"write", report.phases.write_s}}},
              {"peak_memory_bytes", peak_memory()},
              {"bad_samples", r.bad_samples},
              {"bad_pixels", bad_values_json(report.bad_values)},
              {"written", {{"clamped", report.written.clamped}, {"not_finite", report.written.not_finite}}},
              {"threads", r.threads},
              {"isa", r.isa},
              {"traversal", r.traversal},
              {"accelerator", r.accelerator},
              {"versions", versions}};
  for (const auto& [layer, bad] : report.bad_layers) out["bad_pixels"]["layers"][layer] = bad_values_json(bad);
  if (error != nullptr) out["error"] = error->what();
  return json_text(out);
}

void write_statistics(const std::filesystem::path& file, const JobReport& report, const base::Error* error) {
  base::write_text_file(file, statistics_json(report, error));
}

void write_failure(const std::filesystem::path& file, const JobReport& report, const base::Error& error) {
  if (file.empty()) return;
  try {
    write_statistics(file, report, &error);
  } catch (const base::Error&) {
  }
}

}  // namespace orrery::job
