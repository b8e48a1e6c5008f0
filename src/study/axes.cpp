// SPDX-License-Identifier: Apache-2.0
#include "study/axes.h"

#include <algorithm>
#include <memory>

#include <fmt/core.h>

#include "base/text.h"
#include "compile/compiled_scene.h"
#include "compile/environment.h"
#include "scene/scene.h"

namespace orrery::study {
namespace {

using compile::CompiledScene;

/// Samples per pixel of variants whose errors are compared.
constexpr int kCompared = 64;
/// Samples per pixel of variants that produce identical images, so that only render time is compared.
constexpr int kTimed = 16;

/// Maximum number of spheres for which the list is measured.
constexpr std::size_t kMaxListSpheres = 5000;

bool is_dielectric(const kernel::Material& m) { return m.kind == kernel::MaterialKind::kDielectric; }

/// A change of the sampler.
std::function<void(CompiledScene&)> sampled_by(kernel::SamplerKind kind) {
  return [kind](CompiledScene& w) { w.sampler.kind = kind; };
}

class Planner {
 public:
  Planner(const scene::Scene& scene, const CompiledScene& compiled, double noise)
      : scene_(scene), compiled_(compiled), noise_(noise) {}

  AxisPlan plan() {
    samples();
    for (const double times : {4, 2, 1}) noise(times * noise_);
    precision();
    samplers();
    denoising();
    roulette();
    depth();
    fresnel();
    direct_lighting();
    caustics();
    accelerator();
    if (compiled_.sampler.kind == kernel::SamplerKind::kBlueNoise)
      for (Choice& choice : out_.choices)
        if (choice.is_shortcut && !choice.is_denoised) take_sobol(choice);
    return std::move(out_);
  }

 private:
  /// `flags`    besides --samples
  Choice& add(const std::string& axis, const std::string& name, int samples, const std::string& flags) {
    Choice& choice = out_.choices.emplace_back();
    choice.axis = axis;
    choice.name = name;
    choice.flags = fmt::format("--samples {} {}", samples, flags);
    choice.samples = samples;
    return choice;
  }

  void leave_out(const std::string& why) { out_.left_out.push_back(why); }

  /// The bias test of shortcuts requires pixels with independent random numbers, unlike those of blue noise.
  static void take_sobol(Choice& choice) {
    choice.flags += " --set render.sampler=sobol";
    choice.apply = [apply = choice.apply](CompiledScene& w) {
      w.sampler.kind = kernel::SamplerKind::kSobol;
      if (apply) apply(w);
    };
  }

  void samples() {
    for (const int n : {4, 16, 64, 256})
      add("samples", fmt::format("{} sobol", n), n, "--set render.sampler=sobol").apply =
          sampled_by(kernel::SamplerKind::kSobol);
  }

  void noise(double noise) {
    const std::string text = fmt::format("{:g}", noise);
    Choice& c = add("noise", text, compiled_.samples, "");
    c.flags = "--noise " + text;
    c.noise = noise;
  }

  void precision() {
    const auto add_one = [&](const char* name, compile::Precision precision, bool is_shortcut) -> Choice& {
      Choice& c = add("precision", name, kCompared, fmt::format("--precision {}", name));
      c.apply = [precision](CompiledScene& w) { w.precision = precision; };
      c.is_shortcut = is_shortcut;
      return c;
    };
    add_one("exact", compile::Precision::kExact, false);
    add_one("fast", compile::Precision::kFast, true);
    if (!list_is_affordable()) return leave_out("more than 5000 spheres: precision book is too slow");
    Choice& book = add_one("book", compile::Precision::kBook, true);
    book.apply = [](CompiledScene& w) {
      w.precision = compile::Precision::kBook;
      w.accelerator = compile::Accelerator::kList;
    };
    book.slowness = list_slowness();
  }

  void samplers() {
    for (const int n : {16, 64, 256})
      add("sampler", fmt::format("{} independent", n), n, "--set render.sampler=independent").apply =
          sampled_by(kernel::SamplerKind::kIndependent);
    for (const int n : {16, 64})
      add("sampler", fmt::format("{} blue-noise", n), n, "--set render.sampler=blue-noise").apply =
          sampled_by(kernel::SamplerKind::kBlueNoise);
  }

  void denoising() {
    for (const int n : {16, 64}) {
      Choice& c = add("denoise", fmt::format("{} sobol", n), n, "--set render.sampler=sobol --denoise");
      c.apply = sampled_by(kernel::SamplerKind::kSobol);
      c.is_denoised = c.is_shortcut = true;
    }
  }

  bool everything_is_white() const {
    return std::all_of(compiled_.materials.begin(), compiled_.materials.end(), [](const kernel::Material& m) {
      return is_dielectric(m) || (m.albedo[0] == 1 && m.albedo[1] == 1 && m.albedo[2] == 1);
    });
  }

  void roulette() {
    if (is_empty() || everything_is_white()) return leave_out("no absorption: no roulette axis");
    for (const int from : {0, 1, 3})
      add("roulette", from == 0 ? "off" : fmt::format("from {}", from), kCompared,
          fmt::format("--set render.roulette_depth={}", from))
          .apply = [from](CompiledScene& w) {
        w.roulette_depth = from == 0 ? kernel::kNoRoulette : static_cast<std::uint32_t>(from);
      };
  }

  void depth() {
    if (is_empty()) return leave_out("no spheres: no depth axis");
    for (const std::uint32_t depth : {2u, 4u, 8u, 16u}) {
      if (depth >= compiled_.max_depth) continue;
      Choice& c =
          add("depth", fmt::format("at most {}", depth), kCompared, fmt::format("--set render.max_depth={}", depth));
      c.apply = [depth](CompiledScene& w) { w.max_depth = depth; };
      c.is_shortcut = true;
    }
  }

  void fresnel() {
    const std::vector<kernel::Material>& materials = compiled_.materials;
    if (std::none_of(materials.begin(), materials.end(), is_dielectric)) return leave_out("no glass: no Fresnel axis");
    const auto add_one = [&](const char* name, kernel::FresnelKind kind) {
      std::vector<std::string> flags;
      for (const scene::Material& m : scene_.materials)
        if (std::holds_alternative<scene::Dielectric>(m.model))
          flags.push_back(fmt::format("--set material.{}.fresnel={}", m.name, name));
      Choice& c = add("fresnel", name, kCompared, base::joined(flags, " "));
      c.apply = [kind](CompiledScene& w) {
        for (kernel::Material& m : w.materials) m.fresnel = kind;
      };
      c.is_shortcut = std::any_of(materials.begin(), materials.end(),
                                  [kind](const kernel::Material& m) { return is_dielectric(m) && m.fresnel != kind; });
    };
    add_one("exact", kernel::FresnelKind::kExact);
    add_one("schlick", kernel::FresnelKind::kSchlick);
    add_one("none", kernel::FresnelKind::kZero);
  }

  void direct_lighting() {
    if (!compiled_.features.lit) return leave_out("no lights: no direct lighting axis");
    const auto add_one = [&](const char* name, kernel::DirectLighting mode) {
      std::shared_ptr<const compile::EnvironmentMap> environment = compiled_.environment;
      if (environment && mode != compiled_.direct_lighting)
        environment = environment->with_sampling(compile::environment_sampling(mode));
      add("direct lighting", name, kCompared, fmt::format("--set render.direct_lighting={}", name)).apply =
          [mode, environment](CompiledScene& w) {
            w.direct_lighting = mode;
            w.environment = environment;
          };
    };
    add_one("mis", kernel::DirectLighting::kMis);
    add_one("bsdf", kernel::DirectLighting::kBsdf);
  }

  void caustics() {
    const bool sampled = compiled_.direct_lighting != kernel::DirectLighting::kBsdf;
    if (!compiled_.features.caustics && (compiled_.samples_caustics || !sampled))
      return leave_out("no pairs of a sharp ball and a light that is sampled: no caustics axis");
    for (const bool on : {true, false})
      add("caustics", on ? "sampled" : "not sampled", kCompared, fmt::format("--set render.caustics={}", on)).apply =
          [on](CompiledScene& w) { w.samples_caustics = on; };
  }

  bool is_empty() const { return compiled_.spheres.empty() && compiled_.rods.empty(); }

  bool list_is_affordable() const { return compiled_.spheres.size() + compiled_.rod_count() <= kMaxListSpheres; }

  /// Time with the list of spheres and rods relative to that with Embree.
  double list_slowness() const {
    return 1 + static_cast<double>(compiled_.spheres.size() + compiled_.rod_count()) / 12;
  }

  void accelerator() {
    if (is_empty()) return leave_out("no spheres: no accelerator axis");
    add("accelerator", "embree, packets", kTimed, "--set render.traversal=packet").traversal =
        accel::Traversal::kPacket;
    add("accelerator", "embree, single rays", kTimed, "--set render.traversal=single").traversal =
        accel::Traversal::kSingle;
    if (!list_is_affordable()) return leave_out("more than 5000 spheres: the list is too slow");
    Choice& list = add("accelerator", "list", kTimed, "--set render.accelerator=list");
    list.apply = [](CompiledScene& w) { w.accelerator = compile::Accelerator::kList; };
    list.slowness = list_slowness();
    leave_out("Embree's build qualities: equally fast, see docs/benchmarks.md");
  }

  const scene::Scene& scene_;
  const CompiledScene& compiled_;
  double noise_;
  AxisPlan out_;
};

}  // namespace

AxisPlan plan_axes(const scene::Scene& scene, const CompiledScene& compiled, double noise) {
  return Planner(scene, compiled, noise).plan();
}

}  // namespace orrery::study
