// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace orrery::bench {

struct NoiseScene {
  scene::Scene opening;
  std::optional<scene::Scene> closing = {};  ///< at shutter close, if something moves
};

struct NoiseCase {
  std::string name;
  std::function<NoiseScene()> scene;
};

/// Scenes whose noise is hard to estimate: rare, small, blurred or moving light. The rule was made with them.
std::vector<NoiseCase> hard_scenes();

/// Scenes that were made after the rule, to test it.
std::vector<NoiseCase> held_out_scenes();

}  // namespace orrery::bench
