// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace orrery::render {

/// What a render did.
struct Statistics {
  std::uint64_t paths = 0;
  std::uint64_t rays = 0;
  std::uint64_t bad_samples = 0;  ///< not finite; counted and left out of their pixel's mean
  double build_s = 0;             ///< acceleration structure
  double render_s = 0;
  double finish_s = 0;      ///< from sums to the finished picture and its layers
  std::string isa;          ///< instruction set that the kernel ran with, "avx2"
  std::string accelerator;  ///< "embree 3.13.5", "list"
  std::string traversal;    ///< "packet, bounced single": of camera rays, and of bounced ones where it differs
  int threads = 0;
  std::uint64_t fewest_samples = 0, most_samples = 0;  ///< of a pixel
  /// Where noise or seconds were given: the noise that the picture is expected to have, and what it rarely exceeds,
  /// which is what ends the render.
  std::optional<double> expected_noise, noise;
  std::uint64_t unjudged_pixels = 0;  ///< around which too few paths found light for these estimates
  std::string ended_by;               ///< "samples", "noise" or "time", whichever came first
};

}  // namespace orrery::render
