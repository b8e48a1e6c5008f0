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

/// Counts of runs whose true errors were compared with their targets.
struct NoiseScore {
  int runs = 0, above = 0, far_above = 0, not_reached = 0;

  /// Adds runs and prints the median and the maximum of their errors, divided by the target, and how many are above 1.1
  /// and 1.3.
  ///
  /// `not_reached_runs`   number of further runs that did not reach the target
  /// Domain     `ratios` is not empty
  void add(std::vector<double> ratios, int not_reached_runs);
  /// Prints the counts. Returns the exit status: 0 if 98 of 100 runs are within 1.1 times the target, and all within
  /// 1.3.
  int report() const;
};

/// The words between commas.
std::vector<std::string> split(const std::string& text);

}  // namespace orrery::bench
