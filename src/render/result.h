// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "film/partial.h"
#include "film/picture.h"
#include "render/statistics.h"

namespace orrery::render {

/// Result of a render.
struct Result {
  film::Picture picture;   ///< planes R, G, B, A, then the layers; empty if not completed
  film::DeepPicture deep;  ///< empty unless requested
  Statistics statistics;
  bool completed = false;  ///< false: stopped by `cancel`
  /// All sums; if stopped while rendering, the state to resume from. Empty if stopped earlier, and in the result of
  /// finished().
  std::optional<film::Partial> partial;
};

}  // namespace orrery::render
