// SPDX-License-Identifier: Apache-2.0
#include "measure/study.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <utility>

#include "measure/bench_scene.h"
#include "job/choose_isa.h"
#include "job/job_files.h"
#include "job/layers.h"
#include "job/load_scene.h"
#include "job/memory.h"
#include "job/reduced_picture.h"
#include "job/scene_hash.h"
#include "farm/submit.h"
#include "job/threads.h"
#include "job/version.h"
#include "base/atomic_file.h"
#include "base/error.h"
#include "base/file_set.h"
#include "base/text.h"
#include "compile/compile.h"
#include "render/render.h"
#include "measure/axes.h"
#include "measure/file_axis.h"
#include "measure/pareto.h"
#include "measure/paired_errors.h"
#include "measure/spheres.h"

namespace orrery::measure {
namespace {

using Clock = std::chrono::steady_clock;
using compile::CompiledScene;

/// Fractions of the budget.
constexpr double kReferenceShare = 0.3;
constexpr double kPilotShare = 0.2;  ///< testing the recommendation at full resolution
constexpr double kFeatureShare = 0.05;

/// Samples per pixel that the budget should allow for the reference and all points together. The study's image is
/// reduced until it does.
constexpr double kSamplesWanted = 6000;
constexpr double kFewestPixels = 64 * 36;

/// Limits of the samples per pixel in each of the two reference renders.
constexpr double kFewestReferenceSamples = 64, kMostReferenceSamples = 1 << 20;

/// Number of choices that are measured regardless of the budget; a comparison needs two points.
constexpr std::size_t kFewestChoices = 2;

/// Minimum samples per pixel of a render with --noise.
constexpr double kFewestAdaptiveSamples = 16;

class Runner {
 public:
  explicit Runner(const Request& request) : request_(request) {
    job::choose_isa(request.isa);
    out_.threads = request.threads > 0 ? request.threads : job::default_threads();
    out_.budget_s = request.budget_s;
    out_.scene = request.scene.file.string();
    out_.version = job::program_version();
  }

  Study run() {
    load();
    choose_size();
    render_reference();
    measure_axes();
    judge_bias(out_.points);
    measure_files();
    measure_features();
    out_.slopes = slopes_of(out_.points);
    mark_front(out_.points);
    recommend();
    out_.seconds = elapsed();
    tell("done", 1);
    return std::move(out_);
  }

 private:
  double elapsed() const {
    return request_.paths_per_s > 0 ? paths_ / request_.paths_per_s
                                    : std::chrono::duration<double>(Clock::now() - start_).count();
  }
  double left() const { return request_.budget_s - elapsed(); }
  void tell(const std::string& what, double fraction) const {
    if (request_.on_progress) request_.on_progress(what, fraction);
  }
  void tell(const std::string& what) const { tell(what, std::min(elapsed() / request_.budget_s, 0.99)); }

  void load() {
    tell("reading", 0);
    base::FileSet files;
    files.add_input(request_.scene.file, "scene");
    if (!request_.report.empty()) {
      files.add_output(request_.report, "-o");
      base::check_creatable(request_.report);
    }
    job::SceneRequest load;
    load.source = request_.scene;
    read_ = std::move(job::load_scene(load).read);
    scene::Scene& scene = read_.scene;
    job::add_scene_files(request_.scene.file, scene, files);
    if (scene.render.shading != scene::Shading::kPath)
      throw base::Error(base::ErrorKind::kUsage,
                        "a study needs render.shading = \"path\"; the other modes trace no light paths");
    full_ = compile::compile(scene, closing());
    const film::LayerRequest layers = job::choose_layers(scene, full_).request;
    memory_needs_ = job::memory_needs(full_, layers);
    scene.spheres = {};
    scene.points = {};
    if (read_.closing) read_.closing->spheres = {};
    read_s_ = elapsed();
    out_.scene_hash = job::scene_hash(full_);
    out_.scene_width = full_.width;
    out_.scene_height = full_.height;
    out_.spheres = full_.spheres.size();
    plan_ = plan_axes(scene, full_, request_.noise);
    spheres_.take_from(full_);
    world_ = full_;
  }

  /// The scene at shutter close; null without motion.
  const scene::Scene* closing() const { return read_.closing ? &*read_.closing : nullptr; }

  accel::Accel& accel_of(const CompiledScene& compiled) {
    // The accelerator depends on the spheres alone, whose storage does not move when it is lent.
    std::unique_ptr<accel::Accel>& accel = accels_[{compiled.precision, compiled.accelerator}];
    if (!accel) {
      const double begin = elapsed();
      accel = render::build(compiled, out_.threads);
      build_s_ = std::max(build_s_, elapsed() - begin);
    }
    return *accel;
  }

  /// The duration of a render, measured or derived from its paths (Request::paths_per_s).
  double seconds_of(const render::Statistics& did) const {
    return request_.paths_per_s > 0 ? static_cast<double>(did.paths) / request_.paths_per_s : did.render_s;
  }

  render::Result render(CompiledScene& compiled, double noise = 0) {
    const Spheres::Loan loan(spheres_, compiled);
    render::Settings settings;
    settings.threads = out_.threads;
    settings.sampling.noise = noise;
    settings.sampling.unlimited = noise > 0;
    settings.traversal = traversal_;
    settings.cancel = request_.cancel;
    render::Result result = render::render(compiled, accel_of(compiled), settings);
    if (!result.completed) throw base::Error(base::ErrorKind::kStopped, "stopped; the study is incomplete");
    result.picture.planes.resize(3);
    out_.isa = result.statistics.isa;
    paths_ += static_cast<double>(result.statistics.paths);
    return result;
  }

  /// Measures the paths per second of this scene.
  double measured_speed() {
    CompiledScene pilot = full_;
    pilot.samples = 1;
    // At a small size, since a single sample of a large image may exceed the budget.
    resize(pilot, kFewestPixels);
    render(pilot);  // builds the BVH and warms up
    if (request_.paths_per_s > 0) return request_.paths_per_s;
    const double begin = elapsed();
    double paths = 0;
    while (elapsed() - begin < std::min(0.5, request_.budget_s / 50)) {
      pilot.samples *= 2;
      paths += static_cast<double>(render(pilot).statistics.paths);
    }
    return paths / (elapsed() - begin);
  }

  /// Measures the speed and reduces the image until the study fits into the budget, but not below kFewestPixels. Beyond
  /// that, choices are skipped.
  void choose_size() {
    tell("measuring speed");
    paths_per_s_ = measured_speed();
    const double most = static_cast<double>(full_.width) * full_.height;
    const double least = std::min(kFewestPixels, most);
    double samples = 2 * kFewestReferenceSamples;
    for (std::size_t i = 0; i < std::min(kFewestChoices, plan_.choices.size()); ++i)
      samples += 2 * plan_.choices[i].samples;
    const double needed = least * samples / paths_per_s_;
    if (needed > left()) {
      std::string text;
      base::append(text, "--budget is too small: loading this scene, a reference and two choices take %.3g s",
                   1.2 * (elapsed() + needed));
      throw base::Error(base::ErrorKind::kUsage, text);
    }
    resize(world_, std::clamp(left() * (1 - kPilotShare) * paths_per_s_ / kSamplesWanted, least, most));
    out_.width = world_.width;
    out_.height = world_.height;
  }

  /// Reduces an image to at most `pixels` pixels, with the same view.
  void resize(CompiledScene& compiled, double pixels) const {
    format::ReadResult small;
    small.scene = read_.scene;
    small.closing = read_.closing;
    job::reduce_picture(small, pixels);
    const CompiledScene view = compile::compile(small.scene, small.closing ? &*small.closing : nullptr);
    compiled.camera = view.camera;
    compiled.camera_motion = view.camera_motion;
    compiled.width = view.width;
    compiled.height = view.height;
    compiled.window_x = compiled.window_y = 0;
    compiled.frame_width = view.width;
    compiled.frame_height = view.height;
  }

  /// Seeds of the study: 0 and 1 for the two renders of each choice, 2 and 3 for those of the reference. Studies with
  /// different scene seeds share no random numbers.
  std::uint32_t seed(std::uint32_t i) const { return 4 * full_.sampler.seed + i; }

  /// Renders the reference twice, without adaptive sampling, which would make the two halves of the samples dependent.
  void render_reference() {
    tell("rendering the reference");
    CompiledScene compiled = world_;
    compiled.sampler.kind = kernel::SamplerKind::kSobol;
    compiled.precision = compile::Precision::kExact;
    const double affordable = left() * kReferenceShare * paths_per_s_ / (2 * pixels());
    const double samples = std::clamp(affordable, kFewestReferenceSamples, kMostReferenceSamples);
    compiled.samples = static_cast<int>(std::bit_floor(static_cast<unsigned>(samples)));
    for (std::uint32_t i = 0; i < 2; ++i) {
      compiled.sampler.seed = seed(2 + i);
      render::Result result = render(compiled);
      (i == 0 ? reference_.first : reference_.second) = std::move(result.picture);
      out_.reference_s += seconds_of(result.statistics);
    }
    out_.reference_samples = 2.0 * compiled.samples;
    out_.reference_noise = noise_of_mean(reference_);
    out_.reference = mean_of(reference_);
  }

  double pixels() const { return static_cast<double>(world_.width) * world_.height; }

  void measure_axes() {
    out_.left_out = plan_.left_out;
    std::map<std::string, std::string> too_expensive;  // choice names by axis
    for (std::size_t i = 0; i < plan_.choices.size(); ++i) {
      const Choice& choice = plan_.choices[i];
      // Choices are ordered by importance. Those that exceed the budget are listed.
      const double reserve = request_.budget_s * (kPilotShare + kFeatureShare);
      if (i >= kFewestChoices && expected_seconds(choice) > left() - reserve) {
        std::string& names = too_expensive[choice.axis];
        names += (names.empty() ? "" : "; ") + choice.name;
        continue;
      }
      tell(choice.axis + ": " + choice.name);
      measure(choice);
    }
    for (const auto& [axis, names] : too_expensive)
      out_.left_out.push_back(axis + " (" + names + "): exceeds the budget");
  }

  CompiledScene world_of(const Choice& choice) const {
    CompiledScene compiled = world_;
    compiled.samples = choice.samples;
    if (choice.apply) choice.apply(compiled);
    // The blue-noise sampler depends on the sample count.
    compiled.sampler.blue_noise_bits = compile::blue_noise_bits(choice.samples);
    return compiled;
  }

  /// Expected duration of both renders of a choice, including the build of a new accelerator.
  double expected_seconds(const Choice& choice) const {
    const CompiledScene compiled = world_of(choice);
    const double build_s = accels_.count({compiled.precision, compiled.accelerator}) == 0 ? build_s_ : 0;
    const double render_s =
        choice.noise > 0 ? expected_seconds(choice.noise) : choice.samples * pixels() / paths_per_s_;
    return build_s + 2 * render_s * choice.slowness;
  }

  /// Expected duration of a render with --noise, extrapolated from the last such point as 1 / error^2.
  double expected_seconds(double noise) const {
    double seconds = 64 * pixels() / paths_per_s_ * std::pow(0.02 / noise, 2);
    for (const Point& p : out_.points)
      if (p.axis == "noise" && p.error > 0) seconds = p.seconds * std::pow(p.error / noise, 2);
    return seconds;
  }

  void measure(const Choice& choice) {
    Point point;
    point.axis = choice.axis;
    point.name = choice.name;
    point.flags = choice.flags;
    point.is_shortcut = choice.is_shortcut;
    traversal_ = choice.traversal;
    CompiledScene compiled = world_of(choice);
    Pair pair;
    point.seconds = std::numeric_limits<double>::infinity();
    for (std::uint32_t i = 0; i < 2; ++i) {
      compiled.sampler.seed = seed(i);
      render::Result result = render(compiled, choice.noise);
      (i == 0 ? pair.first : pair.second) = std::move(result.picture);
      point.seconds = std::min(point.seconds, seconds_of(result.statistics));
      point.samples = static_cast<double>(result.statistics.paths) / pixels();
    }
    traversal_.reset();
    job::MemoryNeeds needs = memory_needs_;
    needs.embree = compiled.accelerator == compile::Accelerator::kEmbree;
    needs.in_rounds = choice.noise > 0;
    point.memory = job::estimate_memory(needs).total();
    const Errors e = errors_of(pair, reference_);
    point.noise = point.error = e.noise;
    point.bias_squared = e.bias_squared;
    point.bias_chance = e.bias_chance;
    point.energy = e.energy;
    point.picture = std::move(pair.first);
    out_.points.push_back(std::move(point));
  }

  void measure_files() {
    tell("files");
    out_.files = measure_file_axis(out_.reference);
  }

  void measure_features() {
    // bench_features reads the scene and builds its accelerator once more.
    if (read_s_ + build_s_ + 2 * request_.budget_s * kFeatureShare > left()) {
      out_.left_out.push_back("features: exceeds the budget");
      return;
    }
    tell("features");
    measure::BenchRequest bench;
    bench.scene = request_.scene;
    bench.isa = request_.isa;
    bench.rounds = 5;
    bench.seconds = std::clamp(request_.budget_s * kFeatureShare / 5 / 6, 0.02, 0.25);
    bench.cancel = request_.cancel;
    out_.features = measure::bench_features(bench);
  }

  const Point* find(const std::string& axis, const std::string& name) const {
    for (const Point& p : out_.points)
      if (p.axis == axis && p.name == name) return &p;
    return nullptr;
  }

  /// The scene options of the study as text, without --samples, which would limit --noise.
  std::string scene_flags() const {
    std::string flags;
    for (const format::Override& override : request_.scene.overrides)
      if (!override.sets("render.samples")) flags += override.option + " " + farm::shell_quoted(override.typed) + " ";
    if (request_.scene.frame != format::kFirstFrame) base::append(flags, "--frames %d ", request_.scene.frame);
    return flags;
  }

  /// Chooses settings for the target noise and tests them at full resolution.
  void recommend() {
    tell("testing the recommendation");
    CompiledScene compiled = full_;
    std::string flags;
    base::append(flags, "--noise %g", request_.noise);
    Recommendation& r = out_.recommendation;
    const Point* const exact = find("precision", "exact");
    const Point* const fast = find("precision", "fast");
    const bool takes_fast = exact != nullptr && fast != nullptr && compiled.precision == compile::Precision::kExact &&
                            fast->bias < request_.noise / 10 && fast->seconds < 0.95 * exact->seconds;
    if (takes_fast) {
      compiled.precision = compile::Precision::kFast;
      flags += " --precision fast";
      r.bias = std::max(fast->bias, std::abs(fast->energy));
    }
    if (compiled.sampler.kind == kernel::SamplerKind::kIndependent) {
      compiled.sampler.kind = kernel::SamplerKind::kSobol;
      flags += " --set render.sampler=sobol";
    }
    const Point* const without = find("roulette", "off");
    const Point* const with = find("roulette", "from 3");
    if (compiled.roulette_depth == kernel::kNoRoulette && with != nullptr && without != nullptr &&
        with->efficiency > 1.05 * without->efficiency) {
      compiled.roulette_depth = 3;
      flags += " --set render.roulette_depth=3";
    }
    const Pilots pilots = pilot(compiled);
    const Pilot last = pilots.back();
    r.noise = std::min(last.noise, request_.noise);
    r.seconds = last.seconds * growth(pilots, request_.noise, &Point::seconds);
    r.samples = last.samples * growth(pilots, request_.noise, &Point::samples);
    r.command = "orrery render " + farm::shell_quoted(out_.scene) + " -o final.exr " + scene_flags() + flags;
    r.baseline_seconds = baseline_seconds();
    base::append(r.words, "for %.3g %% noise: %s, %.3g s", request_.noise * 100, flags.c_str(), r.seconds);
    if (r.baseline_seconds > 0) base::append(r.words, " instead of %.3g s", r.baseline_seconds);
    if (takes_fast) base::append(r.words, ", bias %.2g %%", r.bias * 100);
  }

  /// Result of a test render at full resolution.
  struct Pilot {
    double noise, seconds, samples;  ///< samples per pixel
  };
  using Pilots = std::vector<Pilot>;

  /// Renders at full resolution with half the noise each time, until the target is reached or the next render would
  /// exceed the budget. If the first one would, scales a point of the study instead.
  Pilots pilot(CompiledScene& compiled) {
    const double full_pixels = static_cast<double>(compiled.width) * compiled.height;
    Pilots out;
    if (kFewestAdaptiveSamples * full_pixels / paths_per_s_ > 0.8 * left()) {
      out_.left_out.push_back("test of the recommendation at full resolution: exceeds the budget");
      const Point& p = point_near(request_.noise);
      out.push_back({p.error, p.seconds * full_pixels / pixels(), p.samples});
      return out;
    }
    for (double noise = 8 * request_.noise;; noise /= 2) {
      if (!out.empty() && noise >= out.back().noise && noise > request_.noise) continue;
      if (!out.empty() && out.back().seconds * growth(out, noise, &Point::seconds) > left()) return out;
      const render::Statistics did = render(compiled, noise).statistics;
      out.push_back({did.noise.value_or(0), seconds_of(did), static_cast<double>(did.paths) / full_pixels});
      if (out.back().noise <= request_.noise) return out;
    }
  }

  /// The point whose error is nearest to a noise, among those with the minimum samples of --noise.
  const Point& point_near(double noise) const {
    const Point* nearest = nullptr;
    const auto distance = [noise](const Point& p) { return std::abs(std::log(p.error / noise)); };
    for (const Point& p : out_.points)
      if ((p.axis == "samples" || p.axis == "noise") && p.samples >= kFewestAdaptiveSamples &&
          (nearest == nullptr || distance(p) < distance(*nearest)))
        nearest = &p;
    return *nearest;  // never null: the second choice has 16 samples
  }

  /// The factor by which `what` grows from the last test render to a given noise, interpolated from the study's points
  /// with --noise.
  double growth(const Pilots& pilots, double noise, double Point::*what) const {
    const double reached = pilots.back().noise;
    if (reached <= noise) return 1;
    std::vector<const Point*> line;
    for (const Point& p : out_.points)
      if (p.axis == "noise" && p.error > 0) line.push_back(&p);
    // Linear interpolation on logarithmic axes, extrapolated beyond the last points.
    const auto at = [&](double error) {
      std::size_t k = 1;
      while (k + 1 < line.size() && error < line[k]->error) ++k;
      const Point &a = *line[k - 1], &b = *line[k];
      const double power = std::clamp(std::log(b.*what / a.*what) / std::log(a.error / b.error), 1.0, 2.5);
      return std::log(b.*what) + power * std::log(b.error / error);
    };
    constexpr double kUsual = 1.75;  // between independent sampling, 2, and quasi-Monte Carlo
    return line.size() < 2 ? std::pow(reached / noise, kUsual) : std::exp(at(noise) - at(reached));
  }

  /// Time for the target noise at full resolution with the book's method: independent samples, uniform over the image.
  double baseline_seconds() const {
    const Point* best = nullptr;
    for (const Point& p : out_.points)
      if (p.axis == "sampler" && p.name.find("independent") != std::string::npos) best = &p;
    if (best == nullptr) return 0;
    const double scale = static_cast<double>(full_.width) * full_.height / pixels();
    return best->seconds * scale * std::pow(best->error / request_.noise, 2);
  }

  const Request& request_;
  Clock::time_point start_ = Clock::now();
  format::ReadResult read_;     ///< without spheres
  CompiledScene world_, full_;  ///< at the study's size and at full resolution, both without spheres
  job::MemoryNeeds memory_needs_;
  Pair reference_;
  Spheres spheres_;
  AxisPlan plan_;
  std::map<std::pair<compile::Precision, compile::Accelerator>, std::unique_ptr<accel::Accel>> accels_;
  std::optional<accel::Traversal> traversal_;
  double read_s_ = 0, build_s_ = 0;  ///< time to load the scene, and to build its slowest accelerator
  double paths_ = 0;                 ///< paths traced so far
  double paths_per_s_ = 0;
  Study out_;
};

}  // namespace

Study run_study(const Request& request) { return Runner(request).run(); }

}  // namespace orrery::measure
