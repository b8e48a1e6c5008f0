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

/// The scenes of a set: "ordinary" and "committed" ones that come with orrery; "hard" ones, with which the rule was
/// made; "held-out" ones, made afterwards to test it.
///
/// Errors     std::runtime_error if there is no such set
std::vector<NoiseCase> scenes_of(const std::string& set);

/// The words between commas.
std::vector<std::string> split(const std::string& text);

}  // namespace orrery::bench
