// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "compile/compiled_scene.h"

namespace orrery::app {

/// Where the chosen precision is not good enough for the scene's proportions: what will be wrong, and by how much.
///
/// Result     a sentence each; empty for precision exact
/// Precision  orders of magnitude, from the error terms of docs/numerics.md
std::vector<std::string> precision_advice(const compile::CompiledScene& compiled);

}  // namespace orrery::app
