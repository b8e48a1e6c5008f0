// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "film/picture.h"
#include "film/sums.h"

namespace orrery::render {

/// Statistics of a render.
struct Statistics {
  std::uint64_t paths = 0;
  std::uint64_t rays = 0;
  std::uint64_t bad_samples = 0;  ///< not finite or too large; excluded from their pixel's mean
  double build_s = 0;             ///< building the acceleration structure
  double render_s = 0;
  double finish_s = 0;      ///< from sums to the finished image and its layers
  std::string isa;          ///< the kernel's instruction set, e.g. "avx2"
  std::string accelerator;  ///< e.g. "embree 3.13.5" or "list"
  std::string traversal;    ///< see accel::Accel::traversal_name()
  int threads = 0;
  std::uint64_t min_samples = 0, max_samples = 0;  ///< per pixel
  /// Adaptive sampling only: the expected noise of the image, and its upper confidence bound, which is compared with
  /// the target.
  std::optional<double> expected_noise, noise;
  std::uint64_t unreliable_pixels = 0;  ///< pixels around which too few paths found light for these estimates
  std::string ended_by;                 ///< "samples", "noise" or "time"

  /// Sets paths, rays, bad_samples and render_s.
  void set(const film::RenderWork& work) {
    paths = work.paths;
    rays = work.rays;
    bad_samples = work.bad_samples;
    render_s = work.seconds;
  }
};

/// Result of a render.
struct Result {
  film::Picture picture;   ///< planes R, G, B, A, then the layers; empty if not completed
  film::DeepPicture deep;  ///< empty unless requested
  Statistics statistics;
  bool completed = false;  ///< false: stopped by `cancel`
  /// Of all samples; if stopped while rendering, the state to resume from. Empty if stopped earlier, and in the result
  /// of finished().
  std::optional<film::Sums> sums;
};

}  // namespace orrery::render
