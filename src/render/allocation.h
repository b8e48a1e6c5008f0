// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace orrery::render {

/// Target noise and sample limits of the next iteration of adaptive sampling.
struct IterationGoal {
  double error_ratio = 0;           ///< target squared error of the image divided by the current one
  std::uint64_t affordable = 0;     ///< maximum samples of this iteration
  std::uint32_t max_per_pixel = 0;  ///< maximum samples of a pixel
};

/// The pixels whose samples are doubled, and the remaining work.
struct PixelSelection {
  std::vector<bool> chosen;        ///< by pixel
  bool any = false;                ///< false: no pixel can reduce the error
  double samples_to_goal = 0;      ///< estimate of the samples of all pixels until the goal, including this iteration
  bool limited_by_pixels = false;  ///< some pixel that needs samples already has max_per_pixel
};

/// Chooses the pixels whose next samples reduce the image's error most.
///
/// For a fixed number of samples, the total squared error is minimal if the marginal reduction per sample is equal in
/// all pixels (Neyman allocation). Selects the pixels whose marginal reduction exceeds the threshold that meets the
/// target noise, then pixels without a reliable error estimate, if the budget allows.
///
/// `samples`              of each pixel, above 0
/// `error_of_one_sample`  squared error of each pixel with one sample
/// `is_unreliable`        1: the pixel has no reliable error estimate
/// Errors                 base::Error(kStopped) in a base::StopScope
/// Reference              neyman1934
PixelSelection choose_pixels(std::span<const std::uint32_t> samples, const std::vector<float>& error_of_one_sample,
                             const std::vector<std::uint8_t>& is_unreliable, const IterationGoal& goal);

}  // namespace orrery::render
