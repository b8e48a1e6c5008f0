// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace orrery::kernel {

enum class SamplerKind : std::uint8_t {
  kIndependent,  ///< independent random numbers
  kSobol,        ///< low discrepancy over a pixel's samples
  kBlueNoise,    ///< also low discrepancy over neighbouring pixels, so that their errors cancel
};

/// The source of a path's random numbers.
///
/// They are a function of (seed, pixel, sample, vertex) alone, so an image does not depend on the order of rendering.
/// Samples from kSecondHalf on form a second sequence, independent of the first: the difference between a pixel's two
/// independent halves estimates its error.
struct Sampler {
  SamplerKind kind = SamplerKind::kSobol;
  std::uint32_t seed = 1;
  int blue_noise_bits = 0;  ///< kBlueNoise: bits of the index that count a pixel's samples, 0..16

  static constexpr std::uint32_t kSecondHalf = 0x80000000u;
};

}  // namespace orrery::kernel
