// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "render/light_guide.h"
#include "render/tile_pool.h"

namespace orrery::render {

/// The squared error of a picture as --noise means it.
struct NoiseEstimate {
  double mean_square = 0;     ///< over the pixels
  double standard_error = 0;  ///< of mean_square
  std::vector<float> of_pixel;

  /// What the squared error of the picture rarely exceeds.
  double upper() const { return mean_square + 2 * standard_error; }
};

/// Estimates the noise of the picture as it is.
NoiseEstimate estimate_noise(const PixelStatistics& statistics, TilePool& pool);

/// Pixels around which too few paths have found light for any estimate to be relied on.
struct MissingEvidence {
  std::vector<std::uint8_t> of_pixel;  ///< 1: it needs more samples whatever its error seems to be
  std::uint64_t count = 0;
};

/// Looks for light around every pixel, its own samples left out.
///
/// A window without any light may be black, or its light may be rare. It is believed to be black after
/// 2 * kSamplesForEvidence samples of a pixel, and the errors of windows in which few paths found light are believed
/// then, too.
MissingEvidence find_missing_evidence(const PixelStatistics& statistics, TilePool& pool);

/// Samples of a half.
inline constexpr std::uint32_t kSamplesForEvidence = 512;

/// The squared error that a single sample of each pixel would have, relative as --noise means it, estimated from the
/// pixels around it: its own samples have no influence, so that a choice by the result cannot favour samples that
/// happen to be bright, dark or alike. Docs: decision 16.
///
/// `noise`    of the same statistics
std::vector<float> errors_of_one_sample(const PixelStatistics& statistics, const NoiseEstimate& noise, TilePool& pool);

}  // namespace orrery::render
