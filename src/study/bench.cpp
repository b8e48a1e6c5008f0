// SPDX-License-Identifier: Apache-2.0
#include "study/bench.h"

#include <algorithm>
#include <map>
#include <memory>
#include <utility>

#include <fmt/core.h>

#include "accel/accel.h"
#include "base/error.h"
#include "base/stop_point.h"
#include "base/stopwatch.h"
#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "job/resources.h"
#include "job/scene_hash.h"
#include "kernel/ray_packet.h"
#include "kernel/render_tile.h"
#include "kernel/scene_view.h"
#include "load/read_scene.h"
#include "render/recorded_rays.h"
#include "render/render.h"
#include "render/result.h"
#include "render/settings.h"

namespace orrery::study {

namespace {

using compile::Precision;

/// Number of pixels of the rendered image: small enough for the list, with many samples per pixel as in final renders.
constexpr double kPixels = 96 * 54;

/// Every kRecordedRows-th row is recorded: about ten thousand paths, so that the recorded rays fit into the caches.
constexpr int kRecordedRows = 4;

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

/// Seconds for tracing recorded rays without camera, shading and accumulation.
template <class T>
double trace_again(const kernel::Tracer& tracer, render::RecordedRays<T>& rays) {
  return render::trace_again(tracer, rays.camera) + render::trace_again(tracer, rays.secondary);
}

/// No further round of builds begins after this time.
constexpr double kLongest = 3;  // s

/// The accelerator that a benchmark compares with the default one: one Embree primitive per sphere if the default has a
/// BVH of many spheres, otherwise such a BVH.
struct AlternativeAccelerator {
  std::string name;
  std::size_t bvh_threshold;  ///< for accel::make_embree
};

AlternativeAccelerator alternative_accelerator(const kernel::SceneView& view) {
  if (accel::objects_in_bvh(view).all() > 0) return {"one by one", accel::kNoBvh};
  return {"BVH", 1};
}

/// Benchmarks accelerator builds on all threads: the accelerator that renders the scene in `exact`, an alternative one
/// (one Embree primitive per sphere, or a SphereBvh), and Embree's built-in sphere points.
///
/// `rounds`   maximum number of rounds; fewer are run if they take seconds
/// Domain     at least one sphere
/// Result     sphere points are last
std::vector<BenchResult> bench_builds(const kernel::SceneView& view, int rounds) {
  struct Method {
    std::string name;
    std::function<std::unique_ptr<accel::Accel>()> build;
    std::vector<double> seconds = {}, spheres_per_s = {};
    std::size_t bytes = 0;
  };
  const AlternativeAccelerator other = alternative_accelerator(view);
  const auto embree = [&](std::size_t threshold) {
    return [&view, threshold] { return accel::make_embree(view, kernel::Precision::kExact, {}, threshold); };
  };
  std::vector<Method> methods = {{"accelerator", embree(accel::bvh_threshold())},
                                 {other.name, embree(other.bvh_threshold)},
                                 {"sphere points", [&view] { return accel::make_native_points(view); }}};
  const auto count = static_cast<double>(view.sphere_count);
  const base::Stopwatch since_begin;
  for (int round = 0; round < rounds && (round == 0 || since_begin.seconds() < kLongest); ++round)
    measure_round(methods, round, [&](Method& method) {
      const base::Stopwatch watch;
      const std::unique_ptr<accel::Accel> built = method.build();
      method.seconds.push_back(watch.seconds());
      method.spheres_per_s.push_back(count / method.seconds.back());
      method.bytes = built->bytes();
    });
  std::vector<BenchResult> out;
  for (const Method& method : methods)
    out.push_back({method.name,
                   quartiles(method.spheres_per_s),
                   ratios(method.seconds, methods.back().seconds),
                   {},
                   static_cast<double>(method.bytes) / count});
  return out;
}

/// Benchmark of closest-hit queries on the same rays: packets and single rays with the structure that the number of
/// spheres decides, then with the alternative one; single rays with Embree's built-in sphere points; and a SIMD list.
class TracingBench {
 public:
  /// Builds the remaining accelerators.
  ///
  /// Domain     the view and the rays outlive this; at least one sphere
  TracingBench(const kernel::SceneView& view, render::RecordedRays<float>& rays, bool with_list) : rays_(rays) {
    for (const auto* packets : {&rays_.camera, &rays_.secondary})
      for (const kernel::RayPacket<float>& packet : *packets) ray_count_ += packet.count;
    const AlternativeAccelerator other = alternative_accelerator(view);
    const std::shared_ptr<const accel::Accel> by_count = accel::make_embree(view, kernel::Precision::kFast);
    const std::shared_ptr<const accel::Accel> alternative =
        accel::make_embree(view, kernel::Precision::kFast, {}, other.bvh_threshold);
    methods_ = {{"packets", by_count, accel::Traversal::kPacket},
                {"single rays", by_count, accel::Traversal::kSingle},
                {other.name + ", packets", alternative, accel::Traversal::kPacket},
                {other.name + ", single", alternative, accel::Traversal::kSingle},
                {"sphere points", accel::make_native_points(view), accel::Traversal::kSingle}};
    if (with_list)
      methods_.push_back(
          {"SIMD list", accel::make_simd_list(view, kernel::Precision::kFast), accel::Traversal::kPacket});
  }

  /// Measures every method once.
  void measure(int round) {
    measure_round(methods_, round, [&](Method& method) {
      method.rays_per_s.push_back(ray_count_ / trace_again(method.accel->tracer(method.traversal), rays_));
    });
  }

  std::vector<BenchResult> results() const {
    std::vector<BenchResult> out;
    for (const Method& method : methods_)
      out.push_back(
          {method.name, quartiles(method.rays_per_s), ratios(method.rays_per_s, methods_.front().rays_per_s)});
    return out;
  }

 private:
  struct Method {
    std::string name;
    std::shared_ptr<const accel::Accel> accel;
    accel::Traversal traversal;
    std::vector<double> rays_per_s = {};
  };

  render::RecordedRays<float>& rays_;
  double ray_count_ = 0;
  std::vector<Method> methods_;
};

enum class Tracer { kEmbree, kList, kSimdList };

struct Case {
  std::string name;
  kernel::Features features;
  Tracer tracer = Tracer::kEmbree;
  Precision precision = Precision::kExact;
  std::optional<accel::Traversal> traversal = {};
  bool samples_lights = true;  ///< false: direct_lighting = "bsdf"
  int samples = 1;
  std::vector<double> paths_per_s = {}, tracing = {};
};

constexpr std::pair<const char*, bool kernel::Features::*> kFeatures[] = {
    {"thin lens", &kernel::Features::lens},
    {"hemisphere", &kernel::Features::hemisphere},
    {"gradient sky", &kernel::Features::gradient},
    {"lights", &kernel::Features::lit},
    {"textures", &kernel::Features::rich_materials}};

/// The compiled scene at the reduced image size.
compile::CompiledScene reduced_scene(const BenchRequest& request) {
  load::SceneRequest load;
  load.source = request.scene;
  load::ReadResult read = std::move(load::load_scene(load).read);
  load::reduce_picture(read, kPixels);
  return compile::compile(read.scene, read.closing ? &*read.closing : nullptr);
}

/// The scene under test with its accelerators and recorded rays.
class Subject {
 public:
  explicit Subject(const BenchRequest& request)
      : request_(request),
        compiled_(reduced_scene(request)),
        required_(compiled_.features),
        direct_lighting_(compiled_.direct_lighting) {}

  const compile::CompiledScene& compiled() const { return compiled_; }
  /// The features that the scene requires; compiled() has those of the last case.
  const kernel::Features& required() const { return required_; }

  /// Renders a case once.
  render::Statistics run(const Case& c) {
    prepare(c);
    compiled_.samples = c.samples;
    render::Settings settings;
    settings.threads = request_.threads;
    settings.traversal = c.traversal;
    settings.cancel = request_.cancel;
    const render::Result result = render::render(compiled_, accel(c), settings);
    if (!result.completed) throw base::Error(base::ErrorKind::kStopped, "stopped; nothing was measured");
    return result.statistics;
  }

  /// Seconds per path for tracing its recorded rays without camera, shading and accumulation.
  double trace_alone(const Case& c) {
    prepare(c);
    const accel::Accel& with = accel(c);
    if (c.precision == Precision::kFast) return seconds_a_path(with, fast_rays(with));
    auto& rays = rays_[c.precision];
    if (rays.paths == 0) rays = render::record_rays<double>(compiled_.view(), with, c.precision, recorded_rows());
    return seconds_a_path(with, rays);
  }

  /// The benchmark of closest-hit queries in `fast`.
  TracingBench tracing_bench(bool with_lists) {
    const Case fast{"", required_, Tracer::kEmbree, Precision::kFast};
    prepare(fast);
    const accel::Accel& with = accel(fast);
    return TracingBench(compiled_.view(), fast_rays(with), with_lists);
  }

 private:
  std::vector<kernel::Tile> recorded_rows() const {
    std::vector<kernel::Tile> rows;
    for (int y = 0; y < compiled_.height; y += kRecordedRows) {
      kernel::Tile row;
      row.y = y;
      row.width = compiled_.width;
      row.height = 1;
      row.sample_end = kernel::kPacketSize;
      rows.push_back(row);
    }
    return rows;
  }

  render::RecordedRays<float>& fast_rays(const accel::Accel& with) {
    if (fast_rays_.paths == 0)
      fast_rays_ = render::record_rays<float>(compiled_.view(), with, Precision::kFast, recorded_rows());
    return fast_rays_;
  }

  void prepare(const Case& c) {
    compiled_.accelerator = c.tracer == Tracer::kEmbree ? compile::Accelerator::kEmbree : compile::Accelerator::kList;
    compiled_.precision = c.precision;
    compiled_.features = c.features;
    compiled_.direct_lighting = c.samples_lights ? direct_lighting_ : kernel::DirectLighting::kBsdf;
    compile::update_lights(compiled_);
  }

  const accel::Accel& accel(const Case& c) {
    auto& built = accels_[{c.tracer, c.precision}];
    if (!built)
      built = c.tracer == Tracer::kSimdList ? accel::make_simd_list(compiled_.view(), c.precision)
                                            : render::build(compiled_, render::available_threads());
    return *built;
  }

  template <class T>
  static double seconds_a_path(const accel::Accel& with, render::RecordedRays<T>& rays) {
    return trace_again(with.tracer(), rays) / static_cast<double>(rays.paths);
  }

  const BenchRequest& request_;
  compile::CompiledScene compiled_;
  kernel::Features required_;
  kernel::DirectLighting direct_lighting_;
  std::map<std::pair<Tracer, Precision>, std::unique_ptr<accel::Accel>> accels_;
  std::map<Precision, render::RecordedRays<double>> rays_;
  render::RecordedRays<float> fast_rays_;
};

bool lists_are_affordable(const compile::CompiledScene& compiled) {
  return 3.0 * compiled.width * compiled.height * static_cast<double>(compiled.spheres.size() + compiled.rod_count()) /
             kListTests <=
         kLongestListSeconds;
}

std::vector<Case> cases_of(const compile::CompiledScene& compiled, Benchmark& out) {
  std::vector<Case> cases;
  const auto add = [&](const std::string& name, Tracer tracer, Precision precision) -> Case& {
    return cases.emplace_back(Case{name, compiled.features, tracer, precision});
  };
  add("embree exact", Tracer::kEmbree, Precision::kExact);
  add("embree fast", Tracer::kEmbree, Precision::kFast);
  add("exact packet", Tracer::kEmbree, Precision::kExact).traversal = accel::Traversal::kPacket;
  add("exact single", Tracer::kEmbree, Precision::kExact).traversal = accel::Traversal::kSingle;
  if (compiled.features.lit && compiled.direct_lighting != kernel::DirectLighting::kBsdf)
    add("exact bsdf", Tracer::kEmbree, Precision::kExact).samples_lights = false;
  if (!lists_are_affordable(compiled)) {
    out.left_out.push_back(fmt::format("lists: with this many spheres one sample per pixel would take more than {} s",
                                       static_cast<int>(kLongestListSeconds)));
    return cases;
  }
  add("SIMD list exact", Tracer::kSimdList, Precision::kExact);
  add("SIMD list fast", Tracer::kSimdList, Precision::kFast);
  add("list exact", Tracer::kList, Precision::kExact);
  add("list fast", Tracer::kList, Precision::kFast);
  add("list book", Tracer::kList, Precision::kBook);
  return cases;
}

std::vector<Case> feature_cases_of(const compile::CompiledScene& compiled) {
  std::vector<Case> cases;
  if (compiled.shading != kernel::Shading::kPath) return cases;
  for (const auto& [name, feature] : kFeatures) {
    if (compiled.features.*feature) continue;
    cases.push_back({name, compiled.features});
    cases.back().features.*feature = true;
  }
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

std::vector<FeatureCost> bench_features(const BenchRequest& request) {
  job::choose_isa();
  Subject subject(request);
  const compile::CompiledScene& compiled = subject.compiled();
  std::vector<Case> cases = {{"embree exact", compiled.features}};
  for (Case& c : feature_cases_of(compiled)) cases.push_back(std::move(c));
  for (Case& c : cases) calibrate(subject, c, request.seconds);
  for (int round = 0; round < request.rounds; ++round)
    measure_round(cases, round, [&](Case& c) { measure(subject, c); });
  std::vector<FeatureCost> out;
  for (const auto& [name, feature] : kFeatures) {
    FeatureCost& cost = out.emplace_back(FeatureCost{name, subject.required().*feature, 0});
    for (const Case& c : cases)
      if (c.name == name) cost.saves = 1 - ratios(c.paths_per_s, cases[0].paths_per_s).median;
  }
  return out;
}

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
  const std::size_t case_count = cases.size();
  for (Case& c : feature_cases_of(compiled)) cases.push_back(std::move(c));
  std::optional<TracingBench> tracing;
  // The accelerators that are compared with Embree know spheres only.
  const bool compares = !compiled.spheres.empty() && compiled.rod_count() == 0;
  if (compiled.rod_count() > 0) out.left_out.push_back("comparison of accelerators: the scene has rods");
  if (request.threads == 1 && compares) tracing.emplace(subject.tracing_bench(lists_are_affordable(compiled)));
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
  for (int round = 0; round < request.rounds; ++round) {
    measure_round(cases, round, [&](Case& c) {
      const render::Statistics did = measure(subject, c);
      if (c.tracer == Tracer::kEmbree && request.threads == 1 && &c < &cases[case_count])
        c.tracing.push_back(subject.trace_alone(c) * c.paths_per_s.back());
      if (&c == &cases[0]) out.rays_per_path = static_cast<double>(did.rays) / static_cast<double>(did.paths);
      if (c.tracer == Tracer::kEmbree) out.accelerator = did.accelerator;
      out.isa = did.isa;
      report_progress();
    });
    if (tracing) tracing->measure(round);
  }
  if (tracing) out.tracing = tracing->results();
  if (compares) out.builds = bench_builds(compiled.view(), request.rounds);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const Case& c = cases[i];
    BenchResult& result = (i < case_count ? out.cases : out.features).emplace_back();
    result = {c.name, quartiles(c.paths_per_s), ratios(c.paths_per_s, cases[0].paths_per_s)};
    if (!c.tracing.empty()) result.tracing = quartiles(c.tracing);
  }
  return out;
}

}  // namespace orrery::study
