// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace orrery::test {

/// Number of lanes of an instance of the kernel: those with one are the reference for those with all.
enum class Lanes : std::uint8_t { kOne, kAll };

}  // namespace orrery::test
