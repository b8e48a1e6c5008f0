// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace orrery::render {

/// Progress of a render.
struct Progress {
  std::uint64_t samples_done = 0;
  std::uint64_t samples_total = 0;
  double seconds = 0;     ///< render time so far, excluding the BVH build
  std::string goal = {};  ///< the limit that will end the render, as text; empty: the sample count
};

}  // namespace orrery::render
