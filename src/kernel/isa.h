// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace orrery::kernel {

/// The instruction set of the kernel and tracer instances that are chosen from now on: "sse4", "avx2", "avx512".
///
/// Result     the name that the chosen instance was compiled with, not the name that was requested
std::string isa_name();

/// The name of a Highway target (HWY_AVX2 etc.), such as an instance reports of itself.
std::string isa_name(std::int64_t target);

/// The instruction sets that this program was compiled for and this processor has, best first; whatever the limit.
std::vector<std::string> available_isas();

/// Uses no better instruction set than this one from now on; empty: the best. Call it from one thread, before kernel
/// and tracer functions are chosen.
///
/// Result     false, and nothing has changed, where it is not among available_isas()
bool limit_isa(std::string_view name);

}  // namespace orrery::kernel
