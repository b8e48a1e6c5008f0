// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace orrery::job {

/// Limits kernel and accelerators to this instruction set; empty: the best available.
///
/// Errors     base::Error(kUsage) if the program or the processor lacks it; lists the available ones
void choose_isa(const std::string& name);

}  // namespace orrery::job
