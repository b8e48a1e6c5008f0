// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "accel/traversal.h"
#include "compile/forward.h"
#include "scene/forward.h"

namespace orrery::study {

/// One setting to measure.
struct Choice {
  std::string axis, name, flags;
  int samples = 1;
  double noise = 0;                                    ///< if above 0, render with --noise instead of `samples`
  std::function<void(compile::CompiledScene&)> apply;  ///< further changes; may be empty
  bool is_shortcut = false;                            ///< converges to a different image
  bool is_denoised = false;                            ///< render with --denoise
  double slowness = 1;                                 ///< estimated time per sample, relative to the scene's settings
  std::optional<accel::Traversal> traversal;           ///< see render::Settings
};

/// The choices to measure, and the axes that have no effect on the scene.
struct AxisPlan {
  std::vector<Choice> choices;
  std::vector<std::string> left_out;  ///< "no glass: no Fresnel axis"
};

/// Plans the choices that affect this scene, the most important first; `noise` is the target of the recommendation.
AxisPlan plan_axes(const scene::Scene& scene, const compile::CompiledScene& compiled, double noise);

}  // namespace orrery::study
