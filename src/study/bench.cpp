// SPDX-License-Identifier: Apache-2.0
#include "study/bench.h"

#include <algorithm>
#include <map>
#include <memory>
#include <utility>

#include <nlohmann/json.hpp>

#include <fmt/core.h>

#include "accel/accel.h"
#include "base/error.h"
#include "base/stop_point.h"
#include "base/text.h"
#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "job/report_text.h"
#include "job/resources.h"
#include "job/scene_hash.h"
#include "kernel/scene_view.h"
#include "load/read_scene.h"
#include "render/render.h"
#include "render/result.h"
#include "render/settings.h"

namespace orrery::study {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Quartiles, low, median, high)

namespace {

using compile::Accelerator;
using compile::Precision;
using nlohmann::json;

/// Number of pixels of the rendered image: small enough for the list, with many samples per pixel as in final renders.
constexpr double kPixels = 96 * 54;

/// Lists are skipped if the naive one would take longer than this for one sample per pixel.
constexpr double kLongestListSeconds = 10;
/// Ray-sphere tests per second of the one-lane kernel.
constexpr double kListTests = 1e8;

constexpr double kMaxSamples = 1 << 20;

double quantile(const std::vector<double>& sorted, double q) {
  const double at = q * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (sorted[above] - sorted[below]) * (at - static_cast<double>(below));
}

/// The quartiles of measurements, linearly interpolated between the two nearest values.
///
/// Domain     at least one value
Quartiles quartiles(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return {quantile(values, 0.25), quantile(values, 0.5), quantile(values, 0.75)};
}

/// The quartiles of the quotients of measurements in the same rounds.
Quartiles ratios(const std::vector<double>& values, const std::vector<double>& reference) {
  std::vector<double> out;
  for (std::size_t i = 0; i < reference.size(); ++i) out.push_back(values[i] / reference[i]);
  return quartiles(std::move(out));
}

/// Calls `measure` for each item. Each round starts with a different one.
template <class Item, class Measure>
void measure_round(std::vector<Item>& items, int round, Measure measure) {
  for (std::size_t i = 0; i < items.size(); ++i) measure(items[(i + static_cast<std::size_t>(round)) % items.size()]);
}

struct Case {
  std::string name;
  Accelerator accelerator = Accelerator::kEmbree;
  Precision precision = Precision::kExact;
  std::optional<accel::Traversal> traversal = {};
  int samples = 1;
  std::vector<double> paths_per_s = {};
};

/// The compiled scene at the reduced image size.
compile::CompiledScene reduced_scene(const BenchRequest& request) {
  load::SceneRequest load;
  load.source = request.scene;
  load::ReadResult read = std::move(load::load_scene(load).read);
  load::reduce_picture(read, kPixels);
  return compile::compile(read.scene, read.closing ? &*read.closing : nullptr);
}

/// The scene under test with its accelerators.
class Subject {
 public:
  explicit Subject(const BenchRequest& request) : request_(request), compiled_(reduced_scene(request)) {}

  const compile::CompiledScene& compiled() const { return compiled_; }

  /// Renders a case once.
  render::Statistics run(const Case& c) {
    compiled_.accelerator = c.accelerator;
    compiled_.precision = c.precision;
    compiled_.samples = c.samples;
    compile::update_lights(compiled_);
    render::Settings settings;
    settings.threads = request_.threads;
    settings.traversal = c.traversal;
    settings.cancel = request_.cancel;
    const render::Result result = render::render(compiled_, accel(c), settings);
    if (!result.completed) throw base::Error(base::ErrorKind::kStopped, "stopped; nothing was measured");
    return result.statistics;
  }

 private:
  const accel::Accel& accel(const Case& c) {
    auto& built = accels_[{c.accelerator, c.precision}];
    if (!built) built = render::build(compiled_, render::available_threads());
    return *built;
  }

  const BenchRequest& request_;
  compile::CompiledScene compiled_;
  std::map<std::pair<Accelerator, Precision>, std::unique_ptr<accel::Accel>> accels_;
};

bool lists_are_affordable(const compile::CompiledScene& compiled) {
  return 3.0 * compiled.width * compiled.height * static_cast<double>(compiled.spheres.size() + compiled.rod_count()) /
             kListTests <=
         kLongestListSeconds;
}

std::vector<Case> cases_of(const compile::CompiledScene& compiled, Benchmark& out) {
  std::vector<Case> cases;
  const auto add = [&](const std::string& name, Accelerator accelerator, Precision precision) -> Case& {
    return cases.emplace_back(Case{name, accelerator, precision});
  };
  add("embree exact", Accelerator::kEmbree, Precision::kExact);
  add("embree fast", Accelerator::kEmbree, Precision::kFast);
  add("exact packet", Accelerator::kEmbree, Precision::kExact).traversal = accel::Traversal::kPacket;
  add("exact single", Accelerator::kEmbree, Precision::kExact).traversal = accel::Traversal::kSingle;
  if (!lists_are_affordable(compiled)) {
    out.left_out.push_back(fmt::format("lists: with this many spheres one sample per pixel would take more than {} s",
                                       static_cast<int>(kLongestListSeconds)));
    return cases;
  }
  add("list exact", Accelerator::kList, Precision::kExact);
  add("list fast", Accelerator::kList, Precision::kFast);
  add("list book", Accelerator::kList, Precision::kBook);
  return cases;
}

/// Increases the sample count of a case until a render takes at least half of `seconds`.
void calibrate(Subject& subject, Case& c, double seconds) {
  for (;;) {
    const double took = std::max(subject.run(c).render_s, 1e-6);
    if (took >= seconds / 2 || c.samples >= kMaxSamples) return;
    // The step is limited, since the first render includes warm-up.
    const double factor = std::clamp(seconds / took, 2.0, 64.0);
    c.samples = static_cast<int>(std::min(c.samples * factor, kMaxSamples));
  }
}

/// Renders a case once and records its speed.
render::Statistics measure(Subject& subject, Case& c) {
  const render::Statistics did = subject.run(c);
  c.paths_per_s.push_back(static_cast<double>(did.paths) / did.render_s);
  return did;
}

}  // namespace

Benchmark bench_scene(const BenchRequest& request) {
  const base::StopScope scope(request.cancel);
  job::choose_isa();
  Subject subject(request);
  const compile::CompiledScene& compiled = subject.compiled();
  Benchmark out;
  out.scene_hash = job::scene_hash(compiled);
  out.spheres = compiled.spheres.size();
  out.width = compiled.width;
  out.height = compiled.height;
  out.threads = request.threads;
  out.rounds = request.rounds;

  std::vector<Case> cases = cases_of(compiled, out);
  const int total = static_cast<int>(cases.size()) * (request.rounds + 1);
  int done = 0;
  const auto report_progress = [&] {
    ++done;
    if (request.on_progress) request.on_progress(done, total);
  };
  for (Case& c : cases) {
    calibrate(subject, c, request.seconds);
    report_progress();
  }
  for (int round = 0; round < request.rounds; ++round)
    measure_round(cases, round, [&](Case& c) {
      const render::Statistics did = measure(subject, c);
      if (&c == &cases[0]) out.rays_per_path = static_cast<double>(did.rays) / static_cast<double>(did.paths);
      if (c.accelerator == Accelerator::kEmbree) out.accelerator = did.accelerator;
      out.isa = did.isa;
      report_progress();
    });
  for (const Case& c : cases)
    out.cases.push_back({c.name, quartiles(c.paths_per_s), ratios(c.paths_per_s, cases[0].paths_per_s)});
  return out;
}

std::string benchmark_text(const Benchmark& b) {
  std::string out;
  job::add_row(out, "scene", "{}, {} spheres, {:.2f} rays per path", b.scene_hash, b.spheres, b.rays_per_path);
  job::add_row(out, "measured", "{} x {} px, {}, {}, {}; {} rounds, median (interquartile range)\n", b.width, b.height,
               base::counted(static_cast<std::uint64_t>(b.threads), "thread"), b.isa, b.accelerator, b.rounds);
  out += fmt::format("{:20} {:>10}  ratio to embree exact\n", "", "M paths/s");
  for (const BenchResult& r : b.cases)
    out += fmt::format("{:20} {:>10.3g}  {:.3g} ({:.3g} .. {:.3g})\n", r.name, r.speed.median / 1e6, r.ratio.median,
                       r.ratio.low, r.ratio.high);
  for (const std::string& text : b.left_out) job::add_row(out += '\n', "left out", "{}", text);
  return out;
}

std::string benchmark_json(const Benchmark& b) {
  json cases = json::array();
  for (const BenchResult& r : b.cases)
    cases.push_back({{"name", r.name}, {"paths_per_s", r.speed}, {"ratio", r.ratio}});
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
                         {"left_out", b.left_out}});
}

}  // namespace orrery::study
