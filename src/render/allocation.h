// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

namespace orrery::render {

/// Target noise and sample limits of the next iteration of adaptive sampling.
struct RoundGoal {
  double error_ratio = 0;            ///< target squared error of the image / current one
  std::uint64_t affordable = 0;      ///< maximum samples of this iteration
  std::uint32_t most_per_pixel = 0;  ///< maximum samples of a pixel
};

/// The pixels whose samples are doubled, and the remaining work.
struct Round {
  std::vector<bool> chosen;        ///< by pixel
  bool any = false;                ///< false: no pixel can reduce the error
  double samples_to_goal = 0;      ///< estimate of the samples of all pixels until the goal, including this iteration
  bool limited_by_pixels = false;  ///< some pixel that needs samples already has most_per_pixel
};

/// Chooses the pixels whose next samples reduce the image's error most.
///
/// For a fixed number of samples, the total squared error is minimal if the marginal reduction per sample is equal in
/// all pixels (Neyman allocation). Selects the pixels whose marginal reduction exceeds the threshold that meets the
/// target noise, then pixels without a reliable error estimate, if the budget allows.
///
/// `samples`              of each pixel, above 0
/// `error_of_one_sample`  squared error of each pixel with one sample
/// `lacks_evidence`       1: the pixel has no reliable error estimate
/// Reference              neyman1934
Round choose_pixels(const std::vector<std::uint32_t>& samples, const std::vector<float>& error_of_one_sample,
                    const std::vector<std::uint8_t>& lacks_evidence, const RoundGoal& goal);

}  // namespace orrery::render
