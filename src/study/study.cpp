// SPDX-License-Identifier: Apache-2.0
#include "study/study.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include <fmt/core.h>

#include "base/error.h"
#include "base/file_set.h"
#include "base/stop_point.h"
#include "base/stopwatch.h"
#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "compile/environment.h"
#include "job/layers.h"
#include "job/resources.h"
#include "job/scene_hash.h"
#include "job/version.h"
#include "load/load_scene.h"
#include "load/read_scene.h"
#include "render/render.h"
#include "render/result.h"
#include "render/settings.h"
#include "study/axes.h"
#include "study/biases.h"
#include "study/recommendation.h"
#include "study/study_renderer.h"

namespace orrery::study {
namespace {

using compile::CompiledScene;

/// Fractions of the budget.
constexpr double kReferenceShare = 0.3;
constexpr double kPilotShare = 0.2;  ///< testing the recommendation at full resolution

/// Samples per pixel that the budget should allow for the reference and all points together. The study's image is
/// reduced until it does.
constexpr double kTargetSamples = 6000;
constexpr double kMinPixels = 64 * 36;

/// Limits of the samples per pixel in each of the two reference renders.
constexpr double kMinReferenceSamples = 64, kMaxReferenceSamples = 1 << 20;

/// Number of choices that are measured regardless of the budget; a comparison needs two points.
constexpr std::size_t kMinChoices = 2;

class Runner {
 public:
  explicit Runner(const Request& request) : request_(request), renderer_(request, job::thread_count(request.threads)) {
    job::choose_isa();
    out_.threads = job::thread_count(request.threads);
    out_.budget_s = request.budget_s;
    out_.scene = request.scene.file.string();
    out_.version = job::program_version();
  }

  Study run() {
    load();
    choose_size();
    render_reference();
    measure_axes();
    test_bias(out_.points);
    out_.slopes = slopes_of(out_.points);
    mark_front(out_.points);
    report_progress("testing the recommendation");
    recommend(request_, full_, paths_per_s_, renderer_, out_);
    out_.isa = renderer_.isa();
    out_.seconds = elapsed();
    report_progress("done", 1);
    return std::move(out_);
  }

 private:
  double elapsed() const { return renderer_.elapsed(); }
  double left() const { return request_.budget_s - elapsed(); }
  void report_progress(const std::string& what, std::optional<double> fraction = {}) const {
    if (request_.on_progress)
      request_.on_progress(what, fraction.value_or(std::min(elapsed() / request_.budget_s, 0.99)));
  }

  void load() {
    report_progress("reading", 0);
    base::FileSet files;
    files.add_input(request_.scene.file, "scene");
    if (!request_.report.empty()) files.add_output(request_.report, "-o");
    load::SceneRequest load;
    load.source = request_.scene;
    read_ = std::move(load::load_scene(load).read);
    scene::Scene& scene = read_.scene;
    load::add_scene_files(request_.scene.file, scene, files);
    if (scene.render.shading != scene::Shading::kPath)
      base::refuse("a study needs render.shading = \"path\"; the other modes trace no light paths");
    full_ = compile::compile(scene, read_.closing ? &*read_.closing : nullptr);
    film::LayerRequest layers = job::choose_layers(scene, full_).request;
    memory_ = job::estimate_memory(full_, layers);
    adaptive_memory_ = job::estimate_memory(full_, layers, {.is_adaptive = true});
    layers.halves = true;
    denoised_memory_ = job::estimate_memory(full_, layers, {.keeps_sums = false});
    scene.spheres = {};
    scene.points = {};
    scene.rods = {};
    scene.rod_files = {};
    if (read_.closing) read_.closing->spheres = {};
    if (read_.closing) read_.closing->rods = {};
    out_.scene_hash = job::scene_hash(full_);
    out_.scene_width = full_.width;
    out_.scene_height = full_.height;
    out_.spheres = full_.spheres.size();
    plan_ = plan_axes(scene, full_, request_.noise);
    renderer_.take_spheres(full_);
    reduced_ = full_;
  }

  /// Measures the speed and reduces the image until the study fits into the budget, but not below kMinPixels. Beyond
  /// that, choices are skipped.
  void choose_size() {
    report_progress("measuring speed");
    CompiledScene pilot = full_;
    resize(pilot, kMinPixels);  // a single sample of a large image may exceed the budget
    paths_per_s_ = renderer_.measure_speed(std::move(pilot));
    const double most = static_cast<double>(full_.width) * full_.height;
    const double least = std::min(kMinPixels, most);
    double samples = 2 * kMinReferenceSamples;
    for (std::size_t i = 0; i < std::min(kMinChoices, plan_.choices.size()); ++i)
      samples += 2 * plan_.choices[i].samples;
    const double needed = least * samples / paths_per_s_;
    if (needed > left())
      base::refuse(fmt::format("--budget is too small: loading this scene, a reference and two choices take {:.3g} s",
                               1.2 * (elapsed() + needed)));
    resize(reduced_, std::clamp(left() * (1 - kPilotShare) * paths_per_s_ / kTargetSamples, least, most));
    out_.width = reduced_.width;
    out_.height = reduced_.height;
  }

  /// Reduces an image to at most `pixels` pixels, with the same view.
  void resize(CompiledScene& compiled, double pixels) const {
    load::ReadResult small;
    small.scene = read_.scene;
    small.closing = read_.closing;
    load::reduce_picture(small, pixels);
    scene::Parts changed;
    changed.view = true;
    compile::update(small.scene, small.closing ? &*small.closing : nullptr, changed, compiled);
  }

  /// Seeds of the study: 0 and 1 for the two renders of each choice, 2 and 3 for those of the reference. Studies with
  /// different scene seeds share no random numbers.
  std::uint32_t seed(std::uint32_t i) const { return 4 * full_.sampler.seed + i; }

  /// Renders the reference twice, without adaptive sampling, which would make the two halves of the samples dependent.
  void render_reference() {
    report_progress("rendering the reference");
    CompiledScene compiled = reduced_;
    compiled.sampler.kind = kernel::SamplerKind::kSobol;
    compiled.precision = compile::Precision::kExact;
    const double affordable = left() * kReferenceShare * paths_per_s_ / (2 * pixels());
    const double samples = std::clamp(affordable, kMinReferenceSamples, kMaxReferenceSamples);
    compiled.samples = static_cast<int>(std::bit_floor(static_cast<unsigned>(samples)));
    for (std::uint32_t i = 0; i < 2; ++i) {
      compiled.sampler.seed = seed(2 + i);
      render::Result result = renderer_.render(compiled);
      (i == 0 ? reference_.first : reference_.second) = std::move(result.picture);
      out_.reference_s += renderer_.seconds_of(result.statistics);
    }
    out_.reference_samples = 2.0 * compiled.samples;
    out_.reference_noise = noise_of_mean(reference_);
    out_.reference = mean_of(reference_);
  }

  double pixels() const { return static_cast<double>(reduced_.width) * reduced_.height; }

  void measure_axes() {
    out_.left_out = plan_.left_out;
    std::map<std::string, std::string> too_expensive;  // choice names by axis
    for (std::size_t i = 0; i < plan_.choices.size(); ++i) {
      const Choice& choice = plan_.choices[i];
      // Choices are ordered by importance. Those that exceed the budget are listed.
      const double reserve = request_.budget_s * kPilotShare;
      if (i >= kMinChoices && expected_seconds(choice) > left() - reserve) {
        std::string& names = too_expensive[choice.axis];
        names += (names.empty() ? "" : "; ") + choice.name;
        continue;
      }
      report_progress(fmt::format("{}: {}", choice.axis, choice.name));
      measure(choice);
    }
    for (const auto& [axis, names] : too_expensive)
      out_.left_out.push_back(fmt::format("{} ({}): exceeds the budget", axis, names));
  }

  CompiledScene scene_for(const Choice& choice) const {
    CompiledScene compiled = reduced_;
    compiled.samples = choice.samples;
    if (choice.apply) choice.apply(compiled);
    // The blue-noise sampler depends on the sample count.
    compiled.sampler.blue_noise_bits = compile::blue_noise_bits(choice.samples);
    return compiled;
  }

  /// Expected duration of both renders of a choice, including the build of a new accelerator.
  double expected_seconds(const Choice& choice) const {
    const CompiledScene compiled = scene_for(choice);
    const double build_s = renderer_.has_accelerator(compiled) ? 0 : renderer_.build_s();
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
    CompiledScene compiled = scene_for(choice);
    Pair pair;
    double seconds_per_path[2] = {};
    point.seconds = std::numeric_limits<double>::infinity();
    for (std::uint32_t i = 0; i < 2; ++i) {
      compiled.sampler.seed = seed(i);
      render::Result result = renderer_.render(compiled, choice.noise, choice.traversal, choice.is_denoised);
      (i == 0 ? pair.first : pair.second) = std::move(result.picture);
      const double seconds = renderer_.seconds_of(result.statistics);
      point.seconds = std::min(point.seconds, seconds);
      point.samples = static_cast<double>(result.statistics.paths) / pixels();
      // With a target noise, the samples depend on the seed.
      seconds_per_path[i] = seconds / static_cast<double>(result.statistics.paths);
    }
    if (std::string warning = spread_warning(seconds_per_path[0], seconds_per_path[1]); !warning.empty())
      out_.warnings.push_back(fmt::format("{}: {}", choice.name, warning));
    job::MemoryEstimate memory = choice.is_denoised ? denoised_memory_ : choice.noise > 0 ? adaptive_memory_ : memory_;
    if (compiled.accelerator == compile::Accelerator::kList) memory.accelerator = 0;
    memory.lights = compiled.light_tree.bytes_of_build();
    if (compiled.environment) memory.background = compiled.environment->bytes();
    point.memory = memory.total();
    point.measured = errors_of(pair, reference_);
    point.error = point.measured.noise;
    point.picture = std::move(pair.first);
    out_.points.push_back(std::move(point));
  }

  const Request& request_;
  StudyRenderer renderer_;
  load::ReadResult read_;         ///< without spheres
  CompiledScene reduced_, full_;  ///< at the study's size and at full resolution, both without spheres
  job::MemoryEstimate memory_, adaptive_memory_, denoised_memory_;  ///< with the scene's settings, --noise, --denoise
  Pair reference_;
  AxisPlan plan_;
  double paths_per_s_ = 0;
  Study out_;
};

}  // namespace

Study run_study(const Request& request) {
  const base::StopScope scope(request.cancel);
  return Runner(request).run();
}

}  // namespace orrery::study
