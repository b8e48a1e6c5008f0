// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/diagnostic.h"
#include "scene/scene.h"

namespace orrery::scene {

/// Of many alike in bulk data, this many are told one by one; of the rest only the number.
inline constexpr std::size_t kMaxReported = 10;

/// Something wrong with more than one value, or with a value among many.
struct SceneDiagnostic {
  base::Severity severity = base::Severity::kError;
  std::string key;  ///< "camera.up", "sphere[3].radius", "points[0][17].center", from 0; empty: the whole scene
  std::string text;
  base::ErrorKind kind = base::ErrorKind::kBadData;  ///< of an error; or kMissingInput
};

/// Finds what makes no sense although every value by itself has the right type: a camera without direction, a lens of
/// no sensible size, numbers outside the domain, materials that do not exist, layers that the scene cannot have,
/// spheres in the same place (a warning).
///
/// Domain     any scene, also with numbers that are not finite
/// `closing`  the scene when the shutter closes, which is checked for coincident spheres only; null: no motion
/// Result     empty if the scene is valid; every problem of a [[sphere]], and of each points file and of all coincident
///            spheres the first kMaxReported and the number of the rest
/// Cost       linear in the number of spheres; see base::find_repeated
std::vector<SceneDiagnostic> validate(const Scene& scene, const Scene* closing = nullptr);

}  // namespace orrery::scene
