// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

namespace orrery::render {

/// What the next round is for.
struct RoundGoal {
  double error_ratio = 0;            ///< wanted squared error of the picture by the present one
  std::uint64_t affordable = 0;      ///< samples that may be spent
  std::uint32_t most_per_pixel = 0;  ///< that no pixel shall exceed
};

/// Pixels that shall double their samples, and how much is left to do.
struct Round {
  std::vector<bool> chosen;        ///< by pixel
  bool any = false;                ///< false: no pixel can bring the goal nearer
  double samples_to_goal = 0;      ///< of all pixels until the goal is reached, this round among them; an estimate
  bool limited_by_pixels = false;  ///< some pixel that should go on has had most_per_pixel
};

/// Chooses the pixels whose next samples reduce the picture's error most.
///
/// The error of a sum of pixels is smallest for a given number of samples where every pixel's last sample reduces it
/// by the same amount (Neyman's allocation): pixels go on whose squared error by their samples lies above a level, and
/// the level is where the goal will be reached. Pixels that lack evidence go on besides, where that can be afforded.
///
/// `samples`              that each pixel has had, above 0
/// `error_of_one_sample`  squared, of each pixel
/// `lacks_evidence`               1: the pixel lacks evidence
/// Source                 neyman1934
Round choose_pixels(const std::vector<std::uint32_t>& samples, const std::vector<float>& error_of_one_sample,
                    const std::vector<std::uint8_t>& lacks_evidence, const RoundGoal& goal);

}  // namespace orrery::render
