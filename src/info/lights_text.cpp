// SPDX-License-Identifier: Apache-2.0
#include "info/lights_text.h"

#include <cstddef>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "base/text.h"
#include "compile/compiled_scene.h"
#include "compile/emitters.h"
#include "compile/environment.h"
#include "kernel/lights.h"

namespace orrery::info {
namespace {

/// Describes how an image background is sampled: "sky by texels above the mean and the sun (87 %)"; empty if it is not.
std::string environment_text(const compile::CompiledScene& compiled) {
  if (!compiled.environment || !compiled.environment->view().is_sampled) return {};
  const kernel::Environment& view = compiled.environment->view();
  std::string out;
  if (view.map_density > 0) out = view.weight_offset > 0 ? "texels above the mean" : "all texels";
  if (view.sun_probability > 0) {
    if (!out.empty()) out += " and ";
    base::append(out, "the sun (%.3g %%)", view.sun_probability * 100);
  }
  return out;
}

}  // namespace

std::uint64_t count_emitters(const compile::CompiledScene& compiled) {
  if (compiled.emission.empty()) return 0;
  std::vector<bool> shines;
  for (const kernel::Emission& e : compiled.emission)
    shines.push_back(e.radiance[0] > 0 || e.radiance[1] > 0 || e.radiance[2] > 0);
  std::vector<std::uint32_t> ids;
  for (std::size_t i = 0; i < compiled.spheres.size(); ++i)
    if (shines[compiled.sphere_materials[i]]) ids.push_back(static_cast<std::uint32_t>(i));
  return compile::without_coincident(compiled.view(), compiled.precision, std::move(ids)).size();
}

std::string lights_text(const compile::CompiledScene& compiled, std::uint64_t count) {
  if (count == 0 && !compiled.environment) return {};
  std::vector<std::string> lights;
  if (count > 0) lights.push_back(fmt::format("{} emitter{}", count, count == 1 ? "" : "s"));
  if (compiled.environment) lights.push_back("background");
  std::string out = base::joined(lights);
  const std::string environment = environment_text(compiled);
  switch (compiled.direct_lighting) {
    case kernel::DirectLighting::kBsdf: return out + "; found by BSDF sampling only";
    case kernel::DirectLighting::kMis: out += "; light and BSDF sampling"; break;
    case kernel::DirectLighting::kLight: out += "; light sampling"; break;
  }
  if (count == 0 && environment.empty()) return out.substr(0, out.find(';')) + "; uniform, found by BSDF sampling only";
  if (count > 0 && !environment.empty()) out += ", half of the light samples to each";
  if (compiled.light_tree.spheres.size() > kernel::Lights::kFew) {
    out += "; emitters by a light tree of " + base::bytes_text(compiled.light_tree.bytes());
  } else if (count > 1) {
    out += "; emitters by their irradiance";
  }
  if (!environment.empty()) {
    out += "; background by " + environment;
  } else if (compiled.environment) {
    out += "; background by BSDF sampling only";
  }
  return out;
}

}  // namespace orrery::info
