// SPDX-License-Identifier: Apache-2.0
#include "study/axes.h"

#include <algorithm>
#include <memory>

#include <fmt/core.h>

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
  Choice& add(const std::string& axis, const std::string& name, const std::string& flags, int samples) {
    Choice& choice = out_.choices.emplace_back();
    choice.axis = axis;
    choice.name = name;
    choice.flags = flags;
    choice.samples = samples;
    return choice;
  }

  /// The bias test of shortcuts requires pixels with independent random numbers, unlike those of blue noise.
  static void take_sobol(Choice& choice) {
    choice.flags += " --set render.sampler=sobol";
    choice.apply = [apply = choice.apply](CompiledScene& w) {
      w.sampler.kind = kernel::SamplerKind::kSobol;
      if (apply) apply(w);
    };
  }

  static std::string flag(int samples) { return fmt::format("--samples {}", samples); }

  void samples() {
    for (const int n : {4, 16, 64, 256}) {
      const std::string name = fmt::format("{} sobol", n);
      add("samples", name, flag(n) + " --set render.sampler=sobol", n).apply = [](CompiledScene& w) {
        w.sampler.kind = kernel::SamplerKind::kSobol;
      };
    }
  }

  void noise(double noise) {
    const std::string text = fmt::format("{:g}", noise);
    add("noise", text, "--noise " + text, compiled_.samples).noise = noise;
  }

  void precision() {
    const auto add_one = [&](const char* name, compile::Precision precision, bool is_shortcut) {
      Choice& c = add("precision", name, fmt::format("{} --precision {}", flag(kCompared), name), kCompared);
      c.apply = [precision](CompiledScene& w) { w.precision = precision; };
      c.is_shortcut = is_shortcut;
    };
    add_one("exact", compile::Precision::kExact, false);
    add_one("fast", compile::Precision::kFast, true);
    if (compiled_.spheres.size() + compiled_.rod_count() > kMaxListSpheres) {
      out_.left_out.push_back("more than 5000 spheres: precision book is too slow");
      return;
    }
    Choice& book = add("precision", "book", flag(kCompared) + " --precision book", kCompared);
    book.apply = [](CompiledScene& w) {
      w.precision = compile::Precision::kBook;
      w.accelerator = compile::Accelerator::kList;
    };
    book.is_shortcut = true;
    book.slowness = list_slowness();
  }

  void samplers() {
    for (const int n : {16, 64, 256})
      add("sampler", fmt::format("{} independent", n), flag(n) + " --set render.sampler=independent", n).apply =
          [](CompiledScene& w) { w.sampler.kind = kernel::SamplerKind::kIndependent; };
    for (const int n : {16, 64})
      add("sampler", fmt::format("{} blue-noise", n), flag(n) + " --set render.sampler=blue-noise", n).apply =
          [](CompiledScene& w) { w.sampler.kind = kernel::SamplerKind::kBlueNoise; };
  }

  void denoising() {
    for (const int n : {16, 64}) {
      Choice& c = add("denoise", fmt::format("{} sobol", n), flag(n) + " --set render.sampler=sobol --denoise", n);
      c.apply = [](CompiledScene& w) { w.sampler.kind = kernel::SamplerKind::kSobol; };
      c.is_denoised = c.is_shortcut = true;
    }
  }

  bool everything_is_white() const {
    return std::all_of(compiled_.materials.begin(), compiled_.materials.end(), [](const kernel::Material& m) {
      return m.kind == kernel::MaterialKind::kDielectric || (m.albedo[0] == 1 && m.albedo[1] == 1 && m.albedo[2] == 1);
    });
  }

  void roulette() {
    if (is_empty() || everything_is_white()) {
      out_.left_out.push_back("no absorption: no roulette axis");
      return;
    }
    for (const int from : {0, 1, 3}) {
      const std::string name = from == 0 ? "off" : fmt::format("from {}", from);
      add("roulette", name, fmt::format("{} --set render.roulette_depth={}", flag(kCompared), from), kCompared).apply =
          [from](CompiledScene& w) {
            w.roulette_depth = from == 0 ? kernel::kNoRoulette : static_cast<std::uint32_t>(from);
          };
    }
  }

  void depth() {
    if (is_empty()) {
      out_.left_out.push_back("no spheres: no depth axis");
      return;
    }
    for (const std::uint32_t depth : {2u, 4u, 8u, 16u}) {
      if (depth >= compiled_.max_depth) continue;
      Choice& c = add("depth", fmt::format("at most {}", depth),
                      fmt::format("{} --set render.max_depth={}", flag(kCompared), depth), kCompared);
      c.apply = [depth](CompiledScene& w) { w.max_depth = depth; };
      c.is_shortcut = true;
    }
  }

  void fresnel() {
    std::vector<std::string> names;
    for (const scene::Material& m : scene_.materials)
      if (std::holds_alternative<scene::Dielectric>(m.model)) names.push_back(m.name);
    const bool in_use =
        std::any_of(compiled_.materials.begin(), compiled_.materials.end(),
                    [](const kernel::Material& m) { return m.kind == kernel::MaterialKind::kDielectric; });
    if (!in_use) {
      out_.left_out.push_back("no glass: no Fresnel axis");
      return;
    }
    const auto add_one = [&](const char* name, kernel::FresnelKind kind) {
      std::string flags = flag(kCompared);
      for (const std::string& material : names) flags += fmt::format(" --set material.{}.fresnel={}", material, name);
      Choice& c = add("fresnel", name, flags, kCompared);
      c.apply = [kind](CompiledScene& w) {
        for (kernel::Material& m : w.materials) m.fresnel = kind;
      };
      c.is_shortcut =
          std::any_of(compiled_.materials.begin(), compiled_.materials.end(), [kind](const kernel::Material& m) {
            return m.kind == kernel::MaterialKind::kDielectric && m.fresnel != kind;
          });
    };
    add_one("exact", kernel::FresnelKind::kExact);
    add_one("schlick", kernel::FresnelKind::kSchlick);
    add_one("none", kernel::FresnelKind::kNone);
  }

  void direct_lighting() {
    if (!compiled_.features.lit) {
      out_.left_out.push_back("no lights: no direct lighting axis");
      return;
    }
    const auto add_one = [&](const char* name, kernel::DirectLighting mode) {
      std::shared_ptr<const compile::EnvironmentMap> environment = compiled_.environment;
      if (environment && mode != compiled_.direct_lighting)
        environment = environment->with_sampling(compile::environment_sampling(mode));
      add("direct lighting", name, fmt::format("{} --set render.direct_lighting={}", flag(kCompared), name), kCompared)
          .apply = [mode, environment](CompiledScene& w) {
        w.direct_lighting = mode;
        w.environment = environment;
      };
    };
    add_one("mis", kernel::DirectLighting::kMis);
    add_one("bsdf", kernel::DirectLighting::kBsdf);
  }

  void caustics() {
    const bool sampled = compiled_.direct_lighting != kernel::DirectLighting::kBsdf;
    if (!compiled_.features.caustics && (compiled_.samples_caustics || !sampled)) {
      out_.left_out.push_back("no pairs of a sharp ball and a light that is sampled: no caustics axis");
      return;
    }
    for (const bool on : {true, false})
      add("caustics", on ? "sampled" : "not sampled", fmt::format("{} --set render.caustics={}", flag(kCompared), on),
          kCompared)
          .apply = [on](CompiledScene& w) { w.samples_caustics = on; };
  }

  bool is_empty() const { return compiled_.spheres.empty() && compiled_.rods.empty(); }

  /// Time with the list of spheres and rods relative to that with Embree.
  double list_slowness() const {
    return 1 + static_cast<double>(compiled_.spheres.size() + compiled_.rod_count()) / 12;
  }

  void accelerator() {
    if (is_empty()) {
      out_.left_out.push_back("no spheres: no accelerator axis");
      return;
    }
    add("accelerator", "embree, packets", flag(kTimed) + " --set render.traversal=packet", kTimed).traversal =
        accel::Traversal::kPacket;
    add("accelerator", "embree, single rays", flag(kTimed) + " --set render.traversal=single", kTimed).traversal =
        accel::Traversal::kSingle;
    if (compiled_.spheres.size() + compiled_.rod_count() > kMaxListSpheres) {
      out_.left_out.push_back("more than 5000 spheres: the list is too slow");
      return;
    }
    Choice& list = add("accelerator", "list", flag(kTimed) + " --set render.accelerator=list", kTimed);
    list.apply = [](CompiledScene& w) { w.accelerator = compile::Accelerator::kList; };
    list.slowness = list_slowness();
    out_.left_out.push_back("Embree's build qualities: equally fast, see docs/benchmarks.md");
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
