// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "compile/forward.h"

namespace orrery::info {

/// Returns warnings about visible errors of the chosen precision, estimated from the scene's ratios of distance to
/// radius.
///
/// Result     one sentence per error with its size; empty for precision exact
/// Precision  orders of magnitude, from the error terms of docs/numerics.md
std::vector<std::string> precision_advice(const compile::CompiledScene& compiled);

}  // namespace orrery::info
