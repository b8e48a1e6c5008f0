// SPDX-License-Identifier: Apache-2.0
#include "study/study.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <memory>
#include <utility>

#include "app/bench_scene.h"
#include "app/choose_isa.h"
#include "app/job_files.h"
#include "app/memory.h"
#include "app/scene_hash.h"
#include "app/threads.h"
#include "app/version.h"
#include "app/working_space.h"
#include "base/atomic_file.h"
#include "base/error.h"
#include "base/file_set.h"
#include "base/text.h"
#include "compile/compile.h"
#include "format/read_scene.h"
#include "kernel/isa.h"
#include "render/render.h"
#include "study/axes.h"
#include "study/file_axis.h"
#include "study/findings.h"
#include "study/paired_errors.h"
#include "study/spheres.h"

namespace orrery::study {
namespace {

using Clock = std::chrono::steady_clock;
using compile::World;

/// Parts of the budget.
constexpr double kReferenceShare = 0.3;
constexpr double kPilotShare = 0.2;  ///< the recommendation, at the scene's own size
constexpr double kFeatureShare = 0.05;

/// Samples of a pixel that the reference and all points together should be able to have; the study's picture is made so
/// small that they can.
constexpr double kSamplesWanted = 6000;
constexpr double kFewestPixels = 64 * 36;

/// A seed for the reference that no point has.
constexpr std::uint32_t kReferenceSeed = 0x5eed0000u;

class Runner {
 public:
  explicit Runner(const Request& request) : request_(request) {
    app::choose_isa(request.isa);
    out_.threads = request.threads > 0 ? request.threads : app::default_threads();
    out_.isa = kernel::isa_name();
    out_.budget_s = request.budget_s;
    out_.scene = request.scene.string();
    out_.version = app::program_version();
  }

  Study run() {
    load();
    choose_size();
    render_reference();
    measure_axes();
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
  double elapsed() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
  double left() const { return request_.budget_s - elapsed(); }
  void tell(const std::string& what, double fraction) const {
    if (request_.on_progress) request_.on_progress(what, fraction);
  }
  void tell(const std::string& what) const { tell(what, std::min(elapsed() / request_.budget_s, 0.99)); }

  void load() {
    tell("reading", 0);
    base::FileSet files;
    files.add_input(request_.scene, "scene");
    if (!request_.report.empty()) {
      files.add_output(request_.report, "-o");
      base::check_creatable(request_.report);
    }
    scene_ = format::read_scene(request_.scene, request_.overrides).scene;
    app::add_scene_files(request_.scene, scene_, files);
    if (scene_.render.shading != scene::Shading::kPath)
      throw base::Error(base::ErrorKind::kUsage,
                        "render.shading shows no light, so there is nothing to trade; set it to \"path\"");
    app::to_working_space(app::config_of(request_.scene, scene_.color), scene_);
    full_ = compile::compile(scene_);
    scene_.spheres = {};
    scene_.points = {};
    out_.scene_hash = app::scene_hash(full_);
    out_.scene_width = full_.width;
    out_.scene_height = full_.height;
    out_.spheres = full_.spheres.size();
    plan_ = plan_axes(scene_, full_, request_.noise);
    spheres_.take_from(full_);
    world_ = full_;
  }

  render::Result render(World& world, double noise, double seconds) {
    const Spheres::Loan loan(spheres_, world);
    // What finds hits looks at the spheres alone, and they stay where they are, whoever has them.
    std::unique_ptr<accel::Accel>& accel = accels_[{world.precision, world.accelerator}];
    if (!accel) accel = render::build(world, out_.threads);
    render::Settings settings;
    settings.threads = out_.threads;
    settings.noise = noise;
    settings.seconds = seconds;
    settings.unlimited = noise > 0 || seconds > 0;
    settings.traversal = traversal_;
    settings.cancel = request_.cancel;
    render::Result result = render::render(world, *accel, settings);
    if (!result.completed) throw base::Error(base::ErrorKind::kStopped, "stopped; the study is not complete");
    result.picture.planes.resize(3);
    return result;
  }

  /// Sees how fast this scene is, and makes the picture so small that the budget goes round.
  void choose_size() {
    tell("measuring the speed");
    World pilot = full_;
    pilot.samples = 1;
    // A small picture, for a large one may take longer than the budget for a single sample.
    resize(pilot, kFewestPixels);
    render(pilot, 0, 0);  // builds, and warms up
    const double begin = elapsed();
    double paths = 0;
    while (elapsed() - begin < std::min(0.5, request_.budget_s / 50)) {
      pilot.samples *= 2;
      paths += static_cast<double>(render(pilot, 0, 0).statistics.paths);
    }
    paths_per_s_ = paths / (elapsed() - begin);
    const double pixels = left() * (1 - kPilotShare) * paths_per_s_ / kSamplesWanted;
    if (pixels < kFewestPixels) {
      const double needed = elapsed() + kFewestPixels * kSamplesWanted / paths_per_s_ / (1 - kPilotShare);
      std::string text;
      base::append(text, "--budget is too small for this scene: a study needs %.0f s at least",
                   std::ceil(1.2 * needed));
      throw base::Error(base::ErrorKind::kUsage, text);
    }
    resize(world_, pixels);
    out_.width = world_.width;
    out_.height = world_.height;
  }

  /// The same view in at most so many pixels.
  void resize(World& world, double pixels) const {
    const double scale = std::min(1.0, std::sqrt(pixels / (static_cast<double>(world.width) * world.height)));
    scene::Scene small = scene_;
    small.image.crop.reset();
    small.image.overscan = 0;
    small.image.width = std::max(8, static_cast<int>(std::lround(out_.scene_width * scale)));
    small.image.height = std::max(8, static_cast<int>(std::lround(out_.scene_height * scale)));
    const World view = compile::compile(small);
    world.camera = view.camera;
    world.width = view.width;
    world.height = view.height;
    world.window_x = world.window_y = 0;
    world.frame_width = view.width;
    world.frame_height = view.height;
  }

  void render_reference() {
    tell("rendering the reference");
    World world = world_;
    world.sampler.kind = kernel::SamplerKind::kSobol;
    world.sampler.seed = kReferenceSeed;
    world.precision = compile::Precision::kExact;
    render::Result result = render(world, 0, left() * kReferenceShare);
    out_.reference_noise = result.statistics.noise.value_or(0);
    out_.reference_samples = static_cast<double>(result.statistics.paths) / pixels();
    out_.reference_s = result.statistics.render_s;
    out_.reference = std::move(result.picture);
  }

  double pixels() const { return static_cast<double>(world_.width) * world_.height; }

  void measure_axes() {
    out_.left_out = plan_.left_out;
    for (const Choice& choice : plan_.choices) {
      // What is told first matters most; what does not fit into the time is named.
      const double cost = choice.noise > 0 ? expected_seconds(choice.noise) : choice.samples * pixels() / paths_per_s_;
      const double reserve = request_.budget_s * (kPilotShare + kFeatureShare);
      if (2 * cost * choice.slowness > left() - reserve) {
        out_.left_out.push_back(choice.axis + ", " + choice.name + ": the budget does not allow it");
        continue;
      }
      tell(choice.axis + ": " + choice.name);
      measure(choice);
    }
  }

  /// From the points with --noise so far: time goes as the inverse square of the error.
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
    render::Result results[2];
    for (std::uint32_t i = 0; i < 2; ++i) {
      World world = world_;
      world.samples = choice.samples;
      world.sampler.seed = i + 1;
      if (choice.apply) choice.apply(world);
      // Noise of neighbours is told apart by the samples that each has.
      world.sampler.blue_noise_bits = compile::blue_noise_bits(choice.samples);
      results[i] = render(world, choice.noise, 0);
      point.memory = app::estimate_memory(full_.width, full_.height, 0, out_.spheres,
                                          world.accelerator == compile::Accelerator::kEmbree)
                         .total();
    }
    traversal_ = render::Traversal::kAuto;
    const Errors e = errors_of(results[0].picture, results[1].picture, out_.reference, out_.reference_noise);
    point.error = e.error;
    point.bias = e.bias;
    point.noise = e.noise;
    point.energy = e.energy;
    point.seconds = std::min(results[0].statistics.render_s, results[1].statistics.render_s);
    point.samples = static_cast<double>(results[0].statistics.paths) / pixels();
    point.efficiency = 1 / (e.error * e.error * point.seconds);
    point.picture = std::move(results[0].picture);
    out_.points.push_back(std::move(point));
  }

  void measure_files() {
    tell("files");
    out_.files = measure_file_axis(out_.reference);
  }

  void measure_features() {
    tell("features");
    app::BenchRequest bench;
    bench.scene = request_.scene;
    bench.overrides = request_.overrides;
    bench.isa = request_.isa;
    bench.rounds = 5;
    bench.seconds = std::clamp(request_.budget_s * kFeatureShare / 5 / 6, 0.02, 0.25);
    bench.cancel = request_.cancel;
    out_.features = app::bench_features(bench);
  }

  const Point* find(const std::string& axis, const std::string& name) const {
    for (const Point& p : out_.points)
      if (p.axis == axis && p.name == name) return &p;
    return nullptr;
  }

  /// What to use for the noise that was asked for, tried at the scene's own size.
  void recommend() {
    tell("trying the recommendation");
    World world = full_;
    std::string flags;
    base::append(flags, "--noise %g", request_.noise);
    Recommendation& r = out_.recommendation;
    const Point* const exact = find("precision", "exact");
    const Point* const fast = find("precision", "fast");
    const bool takes_fast = exact != nullptr && fast != nullptr && world.precision == compile::Precision::kExact &&
                            fast->bias < request_.noise / 10 && fast->seconds < 0.95 * exact->seconds;
    if (takes_fast) {
      world.precision = compile::Precision::kFast;
      flags += " --precision fast";
      r.bias = std::max(fast->bias, std::abs(fast->energy));
    }
    if (world.sampler.kind == kernel::SamplerKind::kIndependent) {
      world.sampler.kind = kernel::SamplerKind::kSobol;
      flags += " --set render.sampler=sobol";
    }
    const Point* const without = find("roulette", "off");
    const Point* const with = find("roulette", "from 3");
    if (world.roulette_depth == kernel::kNoRoulette && with != nullptr && without != nullptr &&
        with->efficiency > 1.05 * without->efficiency) {
      world.roulette_depth = 3;
      flags += " --set render.roulette_depth=3";
    }
    const Pilots pilots = pilot(world);
    const Pilot last = pilots.back();
    r.noise = std::min(last.noise, request_.noise);
    r.seconds = last.seconds * growth(pilots, request_.noise, &Point::seconds);
    r.samples = last.samples * growth(pilots, request_.noise, &Point::samples);
    r.command = "orrery render " + out_.scene + " -o final.exr " + flags;
    r.baseline_seconds = baseline_seconds();
    base::append(r.words, "for %.3g %% noise: %s, %.3g s instead of %.3g s", request_.noise * 100, flags.c_str(),
                 r.seconds, r.baseline_seconds);
    if (takes_fast) base::append(r.words, ", bias %.2g %%", r.bias * 100);
  }

  /// A try at the scene's own size.
  struct Pilot {
    double noise, seconds, samples;  ///< samples per pixel
  };
  using Pilots = std::vector<Pilot>;

  /// Renders with half the noise again and again, until what was asked for is reached or the next would take too long.
  Pilots pilot(World& world) {
    const double full_pixels = static_cast<double>(world.width) * world.height;
    Pilots out;
    const auto add = [&](double noise, double seconds) {
      const render::Statistics did = render(world, noise, seconds).statistics;
      out.push_back({did.noise.value_or(0), did.render_s, static_cast<double>(did.paths) / full_pixels});
    };
    constexpr double kFewestSamples = 16;  // that a render with --noise takes
    if (kFewestSamples * full_pixels / paths_per_s_ > 0.8 * left()) {
      add(request_.noise, std::max(0.8 * left(), 0.2));
      return out;
    }
    for (double noise = 8 * request_.noise;; noise /= 2) {
      if (!out.empty() && noise >= out.back().noise && noise > request_.noise) continue;
      if (!out.empty() && out.back().seconds * growth(out, noise, &Point::seconds) > left()) return out;
      add(noise, 0);
      if (out.back().noise <= request_.noise) return out;
    }
  }

  /// How many times as much of something than in the last try it takes to get down to a noise: as the study's small
  /// pictures do from the one noise to the other.
  double growth(const Pilots& pilots, double noise, double Point::*what) const {
    const double reached = pilots.back().noise;
    if (reached <= noise) return 1;
    std::vector<const Point*> line;
    for (const Point& p : out_.points)
      if (p.axis == "noise" && p.error > 0) line.push_back(&p);
    // Straight lines between points, on logarithmic axes; beyond the last ones these go on.
    const auto at = [&](double error) {
      std::size_t k = 1;
      while (k + 1 < line.size() && error < line[k]->error) ++k;
      const Point &a = *line[k - 1], &b = *line[k];
      const double power = std::clamp(std::log(b.*what / a.*what) / std::log(a.error / b.error), 1.0, 2.5);
      return std::log(b.*what) + power * std::log(b.error / error);
    };
    constexpr double kUsual = 1.75;  // between the law of chance, 2, and that of points spread evenly
    return line.size() < 2 ? std::pow(reached / noise, kUsual) : std::exp(at(noise) - at(reached));
  }

  /// At the scene's size, with independent samples, the same for all pixels, and exact: what the book does.
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
  scene::Scene scene_;
  World world_, full_;  ///< of the study's size and of the scene's, both without spheres
  Spheres spheres_;
  AxisPlan plan_;
  std::map<std::pair<compile::Precision, compile::Accelerator>, std::unique_ptr<accel::Accel>> accels_;
  render::Traversal traversal_ = render::Traversal::kAuto;
  double paths_per_s_ = 0;
  Study out_;
};

}  // namespace

Study run_study(const Request& request) { return Runner(request).run(); }

}  // namespace orrery::study
