// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "base/error.h"
#include "scene/scene.h"

namespace orrery::scene {

/// Maximum number of similar diagnostics of bulk data; of the rest only the number is reported.
inline constexpr std::size_t kMaxReported = 10;

/// A diagnostic that concerns several values of the scene, or one element of bulk data.
struct SceneDiagnostic {
  base::Severity severity = base::Severity::kError;
  std::string key;  ///< "camera.up", "sphere[3].radius", "points[0][17].center", 0-based; empty: the whole scene
  std::string text;
  base::ErrorKind kind = base::ErrorKind::kBadData;  ///< of an error; kBadData or kMissingInput
};

/// Returns what is wrong with the exposure of a light; empty if the light is not too bright.
///
/// `radiance`  its largest component
/// `exposure`  stops
std::string exposure_fault(double radiance, double exposure);

/// Checks what the type and range of a single key cannot: a camera without direction, a lens of absurd size, lights
/// of absurd exposure, numbers outside the domain, materials that do not exist, names of light groups, layers that the
/// scene cannot have, coincident spheres (a warning).
///
/// `closing`  the scene at shutter close, used only to find coincident spheres; null: no motion
/// Domain     any scene, including non-finite numbers
/// Result     empty if the scene is valid; all diagnostics of [[sphere]] tables; the first kMaxReported of each points
///            file and of the coincident spheres, with the number of the rest
/// Cost       linear in the number of spheres; see base::find_repeated
std::vector<SceneDiagnostic> validate(const Scene& scene, const Scene* closing = nullptr);

}  // namespace orrery::scene
