// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace orrery::render {

/// How far a render is.
struct Progress {
  std::uint64_t samples_done = 0;
  std::uint64_t samples_total = 0;
  double seconds = 0;     ///< since rendering began, without building the acceleration structure
  std::string goal = {};  ///< what ends the render, in words; empty: its samples
};

}  // namespace orrery::render
