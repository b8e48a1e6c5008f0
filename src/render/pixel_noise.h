// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/zero_pages.h"
#include "kernel/pixel_sum.h"
#include "math/pixels.h"

namespace orrery::render {

class TilePool;

/// Light of small emitters in a pixel; see emitter_coverage.
struct EmitterCoverage {
  /// Fraction of the pixel; of several, that of a single emitter whose light would have as large a variance.
  float coverage = 0;
  float light = 0;  ///< radiance that they add to the pixel, mean of the three channels
};

/// Statistics of each pixel from its two independent halves of samples, in row-major order.
struct PixelStatistics {
  PixelStatistics(int width_px, int height_px)
      : width(width_px),
        height(height_px),
        samples(math::pixel_count(width_px, height_px)),
        light(samples.size()),
        variance(samples.size()),
        outlier(samples.size()) {}

  /// Sets the statistics of pixel `i` from the sums of its halves, of `half` samples each.
  ///
  /// `largest`  sum of the channels of its largest sample
  void set(std::size_t i, std::uint32_t half, const kernel::PixelSum& a, const kernel::PixelSum& b, float largest);

  std::size_t at(int x, int y) const { return math::pixel_index(x, y, width); }

  int width, height;                        ///< px
  base::ZeroVector<std::uint32_t> samples;  ///< samples in each half, above 0
  base::ZeroVector<float> light;            ///< mean over both halves and the three channels, at least 0
  /// Squared error of `light`, mean of the three channels: as the halves show it, but at least as if only the largest
  /// sample caused it.
  base::ZeroVector<float> variance;
  base::ZeroVector<float> outlier;  ///< by how much the largest sample raises `light`, at least 0
  /// 1: no path reached anything that could emit, so the pixel is black; empty: not known for any pixel.
  base::ZeroVector<std::uint8_t> known_black;
  std::vector<EmitterCoverage> emitters;  ///< empty: there are none
};

/// Samples in each half from which every error estimate counts as reliable.
inline constexpr std::uint32_t kSamplesForReliability = 512;

/// The squared relative display error of an image, the measure of --noise.
struct NoiseEstimate {
  double mean_square = 0;     ///< over the pixels
  double standard_error = 0;  ///< standard error of mean_square

  /// An upper confidence bound (two standard errors) of the image's squared error.
  double upper() const { return mean_square + 2 * standard_error; }
};

/// Estimates the noise of the current image.
///
/// Errors are relative to a pixel's light. A pixel that few bright paths have hit overestimates both, and looks half
/// as noisy as bright, however rare such hits are. Its own light therefore counts only without its largest samples,
/// and otherwise as far as most pixels around it show it as well.
NoiseEstimate estimate_noise(const PixelStatistics& statistics, TilePool& pool);

/// Pixels without a reliable error estimate: too few paths around them have found light.
struct UnreliablePixels {
  std::vector<std::uint8_t> of_pixel;  ///< 1: needs more samples regardless of its estimated error
  std::uint64_t count = 0;             ///< of these, and of pixels that were given up without a hit of their emitter
};

/// The squared error of an image that emitters without hits may cause, if `upper` is that of its noise and `wanted`
/// that of the target.
double tolerated_error(double upper, double wanted);

/// Finds the pixels around which too few paths have found light, and those in which an emitter is expected that too
/// few paths can have hit, unless the image may lack the light of all these emitters.
///
/// `tolerated` see tolerated_error
///
/// A window without light may be black, or its light may be rare. It is assumed to be black after 2 *
/// kSamplesForReliability samples per pixel. From then on, error estimates of windows in which few paths found light
/// are trusted as well.
UnreliablePixels find_unreliable_pixels(const PixelStatistics& statistics, TilePool& pool, double tolerated = 0);

/// The squared relative display error of a single sample of each pixel, estimated from the pixels around it. The
/// pixel's own samples have no influence, so that selecting pixels by the result does not favour pixels whose samples
/// happen to be bright, dark or similar.
std::vector<float> errors_of_one_sample(const PixelStatistics& statistics, TilePool& pool);

}  // namespace orrery::render
