// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace orrery::kernel {

/// The instruction set that kernel and tracers use from now on: "sse4", "avx2", "avx512".
std::string isa_name();

/// The instruction sets that this program holds and this processor has, best first.
std::vector<std::string> available_isas();

/// Uses no better instruction set than this one from now on; before anything is rendered, from one thread.
///
/// Result     false, and nothing has changed, where it is not among available_isas()
bool limit_isa(std::string_view name);

}  // namespace orrery::kernel
