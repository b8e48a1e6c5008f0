// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "compile/compiled_scene.h"
#include "render/render.h"
#include "scene/scene.h"

namespace orrery::measure {

/// One way to render, to be measured.
struct Choice {
  std::string axis, name, flags;
  int samples = 1;
  double noise = 0;                                    ///< above 0: --noise, instead of samples
  std::function<void(compile::CompiledScene&)> apply;  ///< empty: nothing else
  bool is_shortcut = false;                            ///< gives another picture, however many samples
  double slowness = 1;  ///< about how much longer a sample takes than in the scene as it is
  std::optional<accel::Traversal> traversal;
};

struct AxisPlan {
  std::vector<Choice> choices;
  std::vector<std::string> left_out;  ///< "no glass: no Fresnel axis"
};

/// The choices that this scene can feel, the most telling first; `noise` is what a recommendation shall reach.
AxisPlan plan_axes(const scene::Scene& scene, const compile::CompiledScene& compiled, double noise);

}  // namespace orrery::measure
