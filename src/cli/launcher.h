// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace orrery::cli {

/// The variable of the environment that the launcher sets, unless it is set, and that the program removes.
inline constexpr char kTunablesName[] = "GLIBC_TUNABLES", kTunables[] = "glibc.malloc.hugetlb=1";

}  // namespace orrery::cli
