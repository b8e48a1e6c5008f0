// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>

#include "accel/traversal.h"
#include "film/forward.h"
#include "film/layers.h"
#include "render/sampling_limits.h"

namespace orrery::render {

struct Progress;

/// Settings of a render that are not part of the scene.
struct Settings {
  int threads = 0;  ///< 0: as many as available_threads()
  /// Traversal of all rays. Empty: the faster one in the first packets of each thread, see accel::ThreadTraversals.
  std::optional<accel::Traversal> traversal;
  film::LayerRequest layers;  ///< besides the beauty
  SamplingLimits sampling;
  /// Called from one thread at a time: at each whole percent, and at most ten times a second in between.
  std::function<void(const Progress&)> on_progress;
  /// Replaces the clock: seconds as a function of rendered samples, so that tests do not depend on the machine's speed.
  /// Empty: the steady clock. Called from any thread.
  std::function<double(std::uint64_t samples_done)> clock;
  /// Called from any thread with the progress of the BVH build, 0..1.
  std::function<void(double fraction)> on_build;
  const std::atomic<bool>* cancel = nullptr;  ///< polled during the build and between tiles; true stops the render
  /// Polled often, from any thread. If true, the threads wait while `on_snapshot` receives the current state.
  std::function<bool()> snapshot_is_due;
  std::function<void(const film::Partial&)> on_snapshot;
  /// Called on the rendering threads for pixels that have received samples, and for those of an earlier run when a
  /// resumed render begins. These pixels do not change during the call; others may.
  std::function<void(const film::Partial&, const film::RenderedPixels&)> on_pixels;
};

}  // namespace orrery::render
