// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace orrery::job {

/// Limits kernel and tracers to this instruction set; empty: the best one.
///
/// Errors     base::Error(kUsage) if program or processor lack it; names the available ones
void choose_isa(const std::string& name);

}  // namespace orrery::job
