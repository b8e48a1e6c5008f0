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
#include "film/layers.h"
#include "film/partial.h"
#include "film/picture.h"
#include "render/progress.h"
#include "render/sampling_limits.h"
#include "render/statistics.h"

namespace orrery::render {

/// Settings of a render that are not part of the scene.
struct Settings {
  int threads = 0;  ///< 0: as many as available_threads()
  /// Traversal of all rays. Empty: the faster one in this scene, measured separately for camera and secondary rays.
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
  /// resumed render begins. During the call nobody changes these pixels; others change.
  std::function<void(const film::Partial&, const film::RenderedPixels&)> on_pixels;
};

/// Result of a render.
struct Result {
  film::Picture picture;   ///< planes R, G, B, A, then the layers; empty if not completed
  film::DeepPicture deep;  ///< empty unless requested
  Statistics statistics;
  bool completed = false;  ///< false: stopped by `cancel`
  /// All sums; if stopped while rendering, the state to resume from. Absent if stopped earlier, and in finished().
  std::optional<film::Partial> partial;
};

/// The number of processors in the process's affinity mask.
int available_threads();

/// Builds the scene's accelerator for its precision.
///
/// Domain     the compiled scene's spheres outlive the result
/// Errors     base::Error(kInternal) if it cannot be built, kStopped if the monitor cancelled the build
std::unique_ptr<accel::Accel> build(const compile::CompiledScene& compiled, int threads,
                                    const accel::BuildMonitor& monitor = {});

/// Renders an image with an accelerator that was built for this scene and precision.
///
/// `from`     a partial of the same scene and settings to resume from
/// Result     completed == false if stopped by `cancel`; build_s is 0
Result render(const compile::CompiledScene& compiled, accel::Accel& accel, const Settings& settings,
              std::optional<film::Partial> from = {});

/// Builds the accelerator and renders an image.
///
/// The image's bits depend only on the scene, not on threads, tiles, accelerator or interruptions.
///
/// Result     completed == false if stopped by `cancel`
/// Errors     base::Error(kInternal) if the accelerator cannot be built
Result render(const compile::CompiledScene& compiled, const Settings& settings, std::optional<film::Partial> from = {});

/// Samples per pixel that the settings request.
std::uint32_t samples_of(const compile::CompiledScene& compiled, const Settings& settings);

/// Converts a partial to an image; pixels without samples are black.
///
/// `threads`  0: all available
Result finished(const compile::CompiledScene& compiled, const film::LayerRequest& layers, const film::Partial& partial,
                int threads);

/// The version of oneTBB in use.
std::string tbb_version();

}  // namespace orrery::render
