// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

namespace orrery::render {

class TilePool;
struct PixelStatistics;

/// The squared relative display error of an image, the measure of --noise.
struct NoiseEstimate {
  double mean_square = 0;     ///< over the pixels
  double standard_error = 0;  ///< standard error of mean_square
  std::vector<float> of_pixel;

  /// An upper confidence bound (two standard errors) of the image's squared error.
  double upper() const { return mean_square + 2 * standard_error; }
};

/// Estimates the noise of the current image.
NoiseEstimate estimate_noise(const PixelStatistics& statistics, TilePool& pool);

/// Pixels without a reliable error estimate: too few paths around them have found light.
struct UnreliablePixels {
  std::vector<std::uint8_t> of_pixel;  ///< 1: needs more samples regardless of its estimated error
  std::uint64_t count = 0;
};

/// Finds the pixels around which too few paths have found light, excluding each pixel's own samples.
///
/// A window without light may be black, or its light may be rare. It is assumed to be black after 2 *
/// kSamplesForReliability samples per pixel. From then on, error estimates of windows in which few paths found light
/// are trusted as well.
UnreliablePixels find_unreliable_pixels(const PixelStatistics& statistics, TilePool& pool);

/// The squared relative display error of a single sample of each pixel, estimated from the surrounding pixels. The
/// pixel's own samples have no influence, so that selecting pixels by the result does not favour pixels whose samples
/// happen to be bright, dark or similar (decision 16).
///
/// `noise`    estimate from the same statistics
std::vector<float> errors_of_one_sample(const PixelStatistics& statistics, const NoiseEstimate& noise, TilePool& pool);

}  // namespace orrery::render
