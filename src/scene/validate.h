// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "base/finding.h"
#include "scene/scene.h"

namespace orrery::scene {

/// Something wrong with more than one value, or with a value among many.
struct Problem {
  base::Severity severity = base::Severity::kError;
  std::string key;  ///< "camera.up", "sphere[3].radius", "points[0]"; indices from 0
  std::string text;
};

/// Finds what makes no sense although every value by itself is allowed: a camera without direction, radii and centres
/// outside the domain, spheres in the same place (a warning). Of many alike the first ten are told, and their number.
std::vector<Problem> validate(const Scene& scene);

}  // namespace orrery::scene
