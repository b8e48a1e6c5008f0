// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

namespace orrery::render {

/// What is known of the pixels of a picture between two rounds of sampling; both row by row.
struct PixelErrors {
  int width = 0, height = 0;
  std::vector<std::uint32_t> samples;  ///< that each has had
  std::vector<float> squared;          ///< its squared error, estimated from its own samples alone

  double sum() const;
};

/// What the next round is for.
struct RoundGoal {
  double squared_sum = 0;            ///< what the pixels' squared errors shall add up to
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

/// Chooses the pixels whose next samples take away most of the picture's error.
///
/// The error of a sum of pixels is smallest for a given number of samples where every pixel's last sample takes away
/// the same (Neyman's allocation): pixels go on whose squared error by their samples lies above a level, and the level
/// is where the goal will be reached. A pixel's error is too uncertain to be judged alone, so it is judged by the mean
/// over the five by five pixels around it: that keeps the choice, and with it the picture, from favouring samples that
/// happen to agree.
///
/// Source     neyman1934
/// Domain     errors.samples > 0
Round choose_pixels(const PixelErrors& errors, const RoundGoal& goal);

}  // namespace orrery::render
