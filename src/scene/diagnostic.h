// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "base/error.h"

namespace orrery::scene {

/// A diagnostic that concerns several values of the scene, or one element of bulk data.
struct SceneDiagnostic {
  base::Severity severity = base::Severity::kError;
  std::string key;  ///< "camera.up", "sphere[3].radius", "points[0].file", 0-based; empty: the whole scene
  std::string text;
  base::ErrorKind kind = base::ErrorKind::kBadData;  ///< kind of an error: kBadData or kMissingInput
};

}  // namespace orrery::scene
