// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "accel/traversal.h"
#include "film/forward.h"
#include "film/layers.h"

namespace orrery::render {

/// A shard of an image's pixels. Squares are assigned round-robin, so that neighbouring ones, which cost about the
/// same, go to different shards.
struct PixelShard {
  int index = 0;  ///< from 0
  int count = 1;  ///< number of shards
};

/// Side of the squares, px.
inline constexpr int kShardSide = 16;

/// Mask of the pixels that belong to a shard, in row-major order. The shards of one count partition the image.
std::vector<bool> pixels_of(const PixelShard& shard, int width_px, int height_px);

/// Progress of a render.
struct Progress {
  std::uint64_t samples_done = 0;
  std::uint64_t samples_total = 0;
  double seconds = 0;     ///< render time so far, excluding the BVH build
  std::string goal = {};  ///< the limit that will end the render, as text; empty: the sample count
};

/// Settings of a render that are not part of the scene.
struct Settings {
  int threads = 0;  ///< 0: as many as available_threads()
  /// Traversal of all rays. Empty: accel::fastest_traversals().
  std::optional<accel::Traversal> traversal;
  film::LayerRequest layers;  ///< besides the beauty
  /// Target noise, as film/display_error.h measures it: samples go where they reduce the image's error most, until it
  /// is this low. 0: every pixel gets the scene's samples.
  double noise = 0;
  double time_budget_s = 0;  ///< of adaptive sampling, from the start of rendering; 0: none
  bool unlimited = false;    ///< with noise or a time budget: more samples per pixel than the scene's are allowed
  /// Range of each pixel's samples. The sums of disjoint ranges add up to those of one render. end 0: all samples.
  std::uint32_t sample_begin = 0, sample_end = 0;
  PixelShard shard;        ///< only these pixels
  bool keeps_sums = true;  ///< false: a completed image has no Result::sums, whose memory is freed as it is finished
  /// Called from one thread at a time: at each whole percent, and at most ten times a second in between.
  std::function<void(const Progress&)> on_progress;
  /// Replaces the clock: seconds as a function of rendered samples, so that tests do not depend on the machine's speed.
  /// Empty: the steady clock. Called from any thread.
  std::function<double(std::uint64_t samples_done)> clock;
  const std::atomic<bool>* cancel = nullptr;  ///< polled during the build and between tiles; true stops the render
  /// Polled often, from any thread. If true, the threads wait while `on_checkpoint` receives the current state.
  std::function<bool()> checkpoint_is_due;
  std::function<void(const film::Sums&)> on_checkpoint;
  /// Called on the rendering threads for pixels that have received samples, and for those of an earlier run when a
  /// resumed render begins. These pixels do not change during the call; others may.
  std::function<void(const film::Sums&, const film::RenderedPixels&)> on_pixels;

  /// True if the pixels are sampled adaptively.
  bool is_adaptive() const { return noise > 0 || time_budget_s > 0; }
  /// True if these are not all samples of all pixels.
  bool is_partial() const { return sample_end > 0 || shard.count > 1; }
};

}  // namespace orrery::render
