// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace orrery::kernel {

/// The instruction set of kernel and tracer instances that are selected from now on: "sse4", "avx2" or "avx512".
///
/// Result     what the chosen instance was compiled for, not what was requested
std::string isa_name();

/// The name of a Highway target (HWY_AVX2 etc.), as reported by an instance.
std::string isa_name(std::int64_t target);

/// The instruction sets that the program was compiled for and the processor supports, best first, ignoring the limit.
std::vector<std::string> available_isas();

/// Limits kernel and tracer functions that are selected from now on to this instruction set; an empty name removes the
/// limit. Not thread-safe.
///
/// Result     false, with nothing changed, if `name` is not among available_isas()
bool limit_isa(std::string_view name);

/// The version of Highway in use.
std::string highway_version();

}  // namespace orrery::kernel
