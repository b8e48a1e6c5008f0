// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

namespace orrery::kernel {

/// For each lane mask, the permutation that moves the set lanes to the front. The remaining entries are unspecified.
template <class Index, std::size_t kLanes>
constexpr auto make_compaction_table() {
  std::array<std::array<Index, kLanes>, (std::size_t{1} << kLanes)> table{};
  for (std::size_t set = 0; set < table.size(); ++set) {
    std::size_t to = 0;
    for (std::size_t lane = 0; lane < kLanes; ++lane)
      if ((set >> lane & 1) != 0) table[set][to++] = static_cast<Index>(lane);
  }
  return table;
}

template <class Index, std::size_t kLanes>
alignas(64) inline constexpr auto kCompaction = make_compaction_table<Index, kLanes>();

}  // namespace orrery::kernel
