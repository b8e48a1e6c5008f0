// SPDX-License-Identifier: Apache-2.0
#include "study/recommendation.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "base/text.h"
#include "compile/compiled_scene.h"
#include "load/read_scene.h"
#include "render/result.h"
#include "study/study.h"
#include "study/study_renderer.h"

namespace orrery::study {
namespace {

/// Minimum samples per pixel of a render with --noise.
constexpr double kMinAdaptiveSamples = 16;

class Recommender {
 public:
  Recommender(const Request& request, const compile::CompiledScene& full, double paths_per_s, StudyRenderer& renderer,
              Study& study)
      : request_(request), full_(full), paths_per_s_(paths_per_s), renderer_(renderer), study_(study) {}

  void run() {
    compile::CompiledScene compiled = full_;
    std::string flags = fmt::format("--noise {:g}", request_.noise);
    Recommendation& r = study_.recommendation;
    const Point* const exact = find("precision", "exact");
    const Point* const fast = find("precision", "fast");
    const bool takes_fast = exact != nullptr && fast != nullptr && compiled.precision == compile::Precision::kExact &&
                            fast->bias < request_.noise / 10 && fast->seconds < 0.95 * exact->seconds;
    if (takes_fast) {
      compiled.precision = compile::Precision::kFast;
      flags += " --precision fast";
      r.bias = fast->bias;
    }
    std::string sampler_flag;
    if (compiled.sampler.kind == kernel::SamplerKind::kIndependent) {
      compiled.sampler.kind = kernel::SamplerKind::kSobol;
      sampler_flag = " --set render.sampler=sobol";
      flags += sampler_flag;
    }
    const Point* const without = find("roulette", "off");
    const Point* const with = find("roulette", "from 3");
    if (compiled.roulette_depth == kernel::kNoRoulette && with != nullptr && without != nullptr &&
        with->efficiency > 1.05 * without->efficiency) {
      compiled.roulette_depth = 3;
      flags += " --set render.roulette_depth=3";
    }
    const Pilot last = pilot(compiled);
    r.noise = std::min(last.noise, request_.noise);
    r.seconds = last.seconds * growth(last.noise, request_.noise, &Point::seconds);
    r.samples = last.samples * growth(last.noise, request_.noise, &Point::samples);
    const Baseline baseline = this->baseline();
    r.baseline_seconds = baseline.seconds;
    const bool is_faster = baseline.seconds > r.seconds;
    if (baseline.seconds > 0 && !is_faster) {
      // --noise needs more samples than this. The error of Sobol points is not larger than that of the same number of
      // independent ones.
      flags = fmt::format("--samples {}{}", baseline.samples, sampler_flag);
      r.noise = request_.noise;
      r.bias = 0;
      r.seconds = baseline.seconds;
      r.samples = baseline.samples;
    }
    r.command =
        fmt::format("orrery render {} -o final.exr {}{}", base::shell_quoted(study_.scene), scene_flags(), flags);
    r.words = fmt::format("for {:.3g} % noise: {}, {:.3g} s", request_.noise * 100, flags, r.seconds);
    if (is_faster) r.words += fmt::format(" instead of {:.3g} s", baseline.seconds);
    if (r.bias > 0) r.words += fmt::format(", bias {:.2g} %", r.bias * 100);
  }

 private:
  /// Result of a test render at full resolution.
  struct Pilot {
    double noise, seconds, samples;  ///< samples per pixel
  };

  /// Samples per pixel and time for the target noise at full resolution with the book's method: independent samples,
  /// uniform over the image. 0: not known.
  struct Baseline {
    int samples = 0;
    double seconds = 0;
  };

  double left() const { return request_.budget_s - renderer_.elapsed(); }
  double pixels() const { return static_cast<double>(study_.width) * study_.height; }

  const Point* find(const std::string& axis, const std::string& name) const {
    for (const Point& p : study_.points)
      if (p.axis == axis && p.name == name) return &p;
    return nullptr;
  }

  /// The scene options of the study as text, without --samples, which would limit --noise.
  std::string scene_flags() const {
    std::string flags;
    for (const load::Override& override : request_.scene.overrides) {
      if (!override.sets("render.samples")) {
        flags += fmt::format("{} {} ", override.option, base::shell_quoted(override.typed));
        continue;
      }
      for (const load::KeyValue& set : override.values)
        if (set.key != "render.samples") flags += fmt::format("--set {} ", base::shell_quoted(set.text));
    }
    if (request_.scene.frame != load::kFirstFrame) flags += fmt::format("--frames {} ", request_.scene.frame);
    return flags;
  }

  /// Renders at full resolution with half the noise each time, until the target is reached or the next render would
  /// exceed the budget. If the first one would, scales a point of the study instead.
  Pilot pilot(compile::CompiledScene& compiled) {
    const double full_pixels = static_cast<double>(compiled.width) * compiled.height;
    if (kMinAdaptiveSamples * full_pixels / paths_per_s_ > 0.8 * left()) {
      study_.left_out.push_back("test of the recommendation at full resolution: exceeds the budget");
      const Point& p = point_near(request_.noise);
      return {p.error, p.seconds * full_pixels / pixels(), p.samples};
    }
    std::optional<Pilot> last;
    for (double noise = 8 * request_.noise;; noise /= 2) {
      if (last && noise >= last->noise && noise > request_.noise) continue;
      if (last && last->seconds * growth(last->noise, noise, &Point::seconds) > left()) return *last;
      const render::Statistics did = renderer_.render(compiled, noise).statistics;
      last = {did.noise.value_or(0), renderer_.seconds_of(did), static_cast<double>(did.paths) / full_pixels};
      if (last->noise <= request_.noise) return *last;
    }
  }

  /// The point whose error is nearest to a noise, among those with the minimum samples of --noise.
  const Point& point_near(double noise) const {
    const Point* nearest = nullptr;
    const auto distance = [noise](const Point& p) { return std::abs(std::log(p.error / noise)); };
    for (const Point& p : study_.points)
      if ((p.axis == "samples" || p.axis == "noise") && p.samples >= kMinAdaptiveSamples &&
          (nearest == nullptr || distance(p) < distance(*nearest)))
        nearest = &p;
    return *nearest;  // never null: the second choice has 16 samples
  }

  /// The factor by which `what` grows from a test render to a given noise, interpolated from the study's points with
  /// --noise.
  ///
  /// `reached`  noise of the test render
  double growth(double reached, double noise, double Point::*what) const {
    if (reached <= noise) return 1;
    std::vector<const Point*> line;
    for (const Point& p : study_.points)
      if (p.axis == "noise" && p.error > 0) line.push_back(&p);
    // Linear interpolation on logarithmic axes, extrapolated beyond the last points.
    const auto at = [&](double error) {
      std::size_t k = 1;
      while (k + 1 < line.size() && error < line[k]->error) ++k;
      const Point &a = *line[k - 1], &b = *line[k];
      const double power = std::clamp(std::log(b.*what / a.*what) / std::log(a.error / b.error), 1.0, 2.5);
      return std::log(b.*what) + power * std::log(b.error / error);
    };
    constexpr double kTypicalExponent = 1.75;  // between independent sampling, 2, and quasi-Monte Carlo
    return line.size() < 2 ? std::pow(reached / noise, kTypicalExponent) : std::exp(at(noise) - at(reached));
  }

  Baseline baseline() const {
    const Point* best = nullptr;
    for (const Point& p : study_.points)
      if (p.axis == "sampler" && p.name.find("independent") != std::string::npos) best = &p;
    if (best == nullptr) return {};
    constexpr double kMaxForecast = 1 << 30;
    const double samples =
        std::clamp(std::ceil(best->samples * std::pow(best->error / request_.noise, 2)), 1.0, kMaxForecast);
    const double scale = static_cast<double>(full_.width) * full_.height / pixels();
    return {static_cast<int>(samples), best->seconds * scale * samples / best->samples};
  }

  const Request& request_;
  const compile::CompiledScene& full_;
  double paths_per_s_;
  StudyRenderer& renderer_;
  Study& study_;
};

}  // namespace

void recommend(const Request& request, const compile::CompiledScene& full, double paths_per_s, StudyRenderer& renderer,
               Study& study) {
  Recommender(request, full, paths_per_s, renderer, study).run();
}

}  // namespace orrery::study
