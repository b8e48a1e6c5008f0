// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace orrery::app {

/// Uses no better instruction set than the one that was asked for; empty: the best.
///
/// Errors     base::Error(kUsage) where program or processor lack it; names those there are
void choose_isa(const std::string& name);

}  // namespace orrery::app
