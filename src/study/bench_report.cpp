// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "job/statistics.h"
#include "study/bench.h"

namespace orrery::study {
namespace {

/// Median and quartiles, "1.35 (1.31 .. 1.38)".
std::string with_quartiles(const char* format, const Quartiles& q) {
  std::string out;
  base::append(out, format, q.median);
  out += " (";
  base::append(out, format, q.low);
  out += " .. ";
  base::append(out, format, q.high);
  return out + ")";
}

nlohmann::json quartiles_json(const Quartiles& q) { return {{"low", q.low}, {"median", q.median}, {"high", q.high}}; }

nlohmann::json case_json(const BenchCase& c) {
  return {{"name", c.name},
          {"paths_per_s", quartiles_json(c.paths_per_s)},
          {"ratio", quartiles_json(c.ratio)},
          {"tracing", c.tracing ? quartiles_json(*c.tracing) : nlohmann::json()}};
}

}  // namespace

std::string benchmark_text(const Benchmark& b) {
  std::string out;
  base::append(out, "scene       %s, %llu spheres, %.2f rays per path\n", b.scene_hash.c_str(),
               static_cast<unsigned long long>(b.spheres), b.rays_per_path);
  base::append(out, "measured    %d x %d px, %d thread%s, %s, %s; %d rounds, median (interquartile range)\n\n", b.width,
               b.height, b.threads, b.threads == 1 ? "" : "s", b.isa.c_str(), b.accelerator.c_str(), b.rounds);
  base::append(out, "%-20s %10s  %-24s %s\n", "", "M paths/s", "ratio to embree exact", "tracing alone");
  for (const BenchCase& c : b.cases) {
    base::append(out, "%-20s %10.3g  ", c.name.c_str(), c.paths_per_s.median / 1e6);
    const std::string ratio = with_quartiles("%.3g", c.ratio);
    if (c.tracing) {
      base::append(out, "%-24s %.0f %%\n", ratio.c_str(), c.tracing->median * 100);
    } else {
      out += ratio + "\n";
    }
  }
  if (!b.tracing.empty()) base::append(out, "\n%-20s %10s  %s\n", "fast, hits only", "M rays/s", "ratio to packets");
  for (const BenchTracing& t : b.tracing)
    base::append(out, "%-20s %10.3g  %s\n", t.name.c_str(), t.rays_per_s.median / 1e6,
                 with_quartiles("%.3g", t.ratio).c_str());
  if (!b.builds.empty())
    base::append(out, "\n%-20s %12s  %-24s %s\n", "build, all threads", "M spheres/s", "relative time", "bytes/sphere");
  for (const BenchBuild& build : b.builds)
    base::append(out, "%-20s %12.3g  %-24s %.0f\n", build.name.c_str(), build.spheres_per_s.median / 1e6,
                 with_quartiles("%.3g", build.ratio).c_str(), build.bytes_per_sphere);
  if (!b.features.empty()) out += "\nembree exact with one feature added\n";
  for (const BenchCase& c : b.features)
    base::append(out, "%-20s %10.3g  %s\n", c.name.c_str(), c.paths_per_s.median / 1e6,
                 with_quartiles("%.3g", c.ratio).c_str());
  for (const std::string& text : b.left_out) base::append(out, "\nleft out    %s\n", text.c_str());
  return out;
}

std::string benchmark_json(const Benchmark& b) {
  using nlohmann::json;
  json cases = json::array(), features = json::array(), tracing = json::array(), builds = json::array();
  for (const BenchTracing& t : b.tracing)
    tracing.push_back(
        {{"name", t.name}, {"rays_per_s", quartiles_json(t.rays_per_s)}, {"ratio", quartiles_json(t.ratio)}});
  for (const BenchBuild& build : b.builds)
    builds.push_back({{"name", build.name},
                      {"spheres_per_s", quartiles_json(build.spheres_per_s)},
                      {"ratio", quartiles_json(build.ratio)},
                      {"bytes_per_sphere", build.bytes_per_sphere}});
  for (const BenchCase& c : b.cases) cases.push_back(case_json(c));
  for (const BenchCase& c : b.features) features.push_back(case_json(c));
  return job::json_text({{"schema", "orrery.bench/1"},
                         {"scene_hash", b.scene_hash},
                         {"spheres", b.spheres},
                         {"rays_per_path", b.rays_per_path},
                         {"width", b.width},
                         {"height", b.height},
                         {"threads", b.threads},
                         {"rounds", b.rounds},
                         {"isa", b.isa},
                         {"accelerator", b.accelerator},
                         {"cases", cases},
                         {"tracing", tracing},
                         {"builds", builds},
                         {"features", features},
                         {"left_out", b.left_out}});
}

}  // namespace orrery::study
