// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string_view>

#include <nlohmann/json.hpp>

#include <fmt/core.h>

#include "base/text.h"
#include "job/report_text.h"
#include "study/bench.h"

namespace orrery::study {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Quartiles, low, median, high)

namespace {

using nlohmann::json;

/// The columns of a table.
struct Columns {
  std::string_view name, speed, ratio, last;
};

/// A table: names, speeds in millions, ratios as "1.35 (1.31 .. 1.38)", and what `last` returns for each result.
template <class Last>
std::string table(const Columns& titles, const std::vector<BenchResult>& results, Last last) {
  const std::size_t width = std::max<std::size_t>(10, titles.speed.size() + 1);
  std::string out;
  const auto add = [&](const Columns& row) {
    out += fmt::format("{:<20} {:>{}}  {:<24} {}", row.name, row.speed, width, row.ratio, row.last);
    out.erase(out.find_last_not_of(' ') + 1);
    out += '\n';
  };
  add(titles);
  for (const BenchResult& r : results)
    add({r.name, fmt::format("{:.3g}", r.speed.median / 1e6),
         fmt::format("{:.3g} ({:.3g} .. {:.3g})", r.ratio.median, r.ratio.low, r.ratio.high), last(r)});
  return out;
}

/// `speed`    key of the speeds
json json_of(const std::vector<BenchResult>& results, const char* speed) {
  json out = json::array();
  for (const BenchResult& r : results) out.push_back({{"name", r.name}, {speed, r.speed}, {"ratio", r.ratio}});
  return out;
}

json json_of_renders(const std::vector<BenchResult>& results) {
  json out = json_of(results, "paths_per_s");
  for (std::size_t i = 0; i < results.size(); ++i) out[i]["tracing"] = job::json_or_null(results[i].tracing);
  return out;
}

}  // namespace

std::string benchmark_text(const Benchmark& b) {
  const auto nothing = [](const BenchResult&) { return std::string(); };
  std::string out;
  job::add_row(out, "scene", "{}, {} spheres, {:.2f} rays per path", b.scene_hash, b.spheres, b.rays_per_path);
  job::add_row(out, "measured", "{} x {} px, {}, {}, {}; {} rounds, median (interquartile range)\n", b.width, b.height,
               base::counted(static_cast<std::uint64_t>(b.threads), "thread"), b.isa, b.accelerator, b.rounds);
  out += table({"", "M paths/s", "ratio to embree exact", "tracing alone"}, b.cases,
               [](const BenchResult& r) { return r.tracing ? fmt::format("{:.0f} %", r.tracing->median * 100) : ""; });
  if (!b.tracing.empty())
    out += "\n" + table({"fast, hits only", "M rays/s", "ratio to packets", ""}, b.tracing, nothing);
  if (!b.builds.empty())
    out += "\n" + table({"build, all threads", "M spheres/s", "relative time", "bytes/sphere"}, b.builds,
                        [](const BenchResult& r) { return fmt::format("{:.0f}", r.bytes_per_sphere); });
  if (!b.features.empty())
    out += "\n" + table({"embree exact with one feature added", "", "", ""}, b.features, nothing);
  for (const std::string& text : b.left_out) job::add_row(out += '\n', "left out", "{}", text);
  return out;
}

std::string benchmark_json(const Benchmark& b) {
  json builds = json_of(b.builds, "spheres_per_s");
  for (std::size_t i = 0; i < builds.size(); ++i) builds[i]["bytes_per_sphere"] = b.builds[i].bytes_per_sphere;
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
                         {"cases", json_of_renders(b.cases)},
                         {"tracing", json_of(b.tracing, "rays_per_s")},
                         {"builds", builds},
                         {"features", json_of_renders(b.features)},
                         {"left_out", b.left_out}});
}

}  // namespace orrery::study
