// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "accel/accel.h"
#include "compile/compiled_scene.h"
#include "film/picture.h"
#include "film/layers.h"
#include "film/partial.h"
#include "render/progress.h"
#include "render/sampling_limits.h"
#include "render/statistics.h"

namespace orrery::render {

struct Settings {
  int threads = 0;  ///< 0: as many as available_threads()
  /// Traversal of all rays. Empty: the faster one in this scene, measured separately for camera and scattered rays.
  std::optional<accel::Traversal> traversal;
  film::LayerRequest layers;  ///< beside the beauty; none cost nothing
  SamplingLimits sampling;
  /// Called from one thread at a time: at each whole percent, and ten times a second at most between these.
  std::function<void(const Progress&)> on_progress;
  /// Seconds that rendering so many samples takes. For tests, which must not depend on the machine's speed; empty: the
  /// steady clock is read. From any thread.
  std::function<double(std::uint64_t samples_done)> clock;
  /// Called while the hierarchy is built, with what is done of it, 0..1, from any thread.
  std::function<void(double fraction)> on_build;
  const std::atomic<bool>* cancel = nullptr;  ///< looked at while building and between tiles; true stops the render
  /// Asked often, from any thread: true has the threads wait while `on_snapshot` gets what there is so far.
  std::function<bool()> snapshot_is_due;
  std::function<void(const film::Partial&)> on_snapshot;
  bool keep_partial = false;  ///< the result shall have what it was made of
};

struct Result {
  film::Picture picture;   ///< planes R, G, B, A, then the layers; empty when not completed
  film::DeepPicture deep;  ///< empty unless it was asked for
  Statistics statistics;
  bool completed = false;  ///< false: stopped by `cancel`
  /// Where it was stopped while rendering, what it can go on from; completed, where the settings say so.
  std::optional<film::Partial> partial;
};

/// Threads this process may use: the processors in its affinity mask.
int available_threads();

/// Builds what finds hits, as the world's accelerator and precision ask for it.
///
/// Domain     the world's spheres outlive the result
/// Errors     base::Error(kInternal) where it cannot be built, kStopped where the monitor said so
std::unique_ptr<accel::Accel> build(const compile::CompiledScene& compiled, int threads,
                                    const accel::BuildMonitor& monitor = {});

/// Renders a whole picture with hits of an `accel` that was built for this world's spheres and precision.
///
/// `from`     a partial of this world and these settings, to go on from; none: from the beginning
/// Result     completed == false where `cancel` stopped it; build_s is 0
Result render(const compile::CompiledScene& compiled, accel::Accel& accel, const Settings& settings,
              std::optional<film::Partial> from = {});

/// Builds, and renders a whole picture.
///
/// The picture's bits depend on the world alone, not on threads, tiles, accelerator, or how often it was stopped on the
/// way.
///
/// Result     completed == false where `cancel` stopped it
/// Errors     base::Error(kInternal) where the acceleration structure cannot be built
Result render(const compile::CompiledScene& compiled, const Settings& settings, std::optional<film::Partial> from = {});

/// Samples of a pixel that the settings ask for.
std::uint32_t samples_of(const compile::CompiledScene& compiled, const Settings& settings);

/// The picture that a partial comes to as it is, where a pixel without samples is black.
Result finished(const compile::CompiledScene& compiled, const film::LayerRequest& layers, film::Partial partial);

}  // namespace orrery::render
