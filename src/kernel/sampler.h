// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace orrery::kernel {

enum class SamplerKind : std::uint8_t {
  kIndependent,  ///< every number by chance
  kSobol,        ///< the numbers of a pixel's samples spread evenly
  kBlueNoise,    ///< and those of neighbouring pixels against each other
};

/// Where the numbers come from by which paths choose their ways.
///
/// They are named by (seed, pixel, sample, vertex) alone, so that a picture does not depend on who asks, or when.
/// Sample numbers from kSecondHalf on are a sequence of their own, independent of the first: two halves of a pixel that
/// know nothing of each other tell its error.
struct Sampler {
  SamplerKind kind = SamplerKind::kSobol;
  std::uint32_t seed = 1;
  int blue_noise_bits = 0;  ///< kBlueNoise: so many bits count the samples of a pixel, 0..16

  static constexpr std::uint32_t kSecondHalf = 0x80000000u;
};

}  // namespace orrery::kernel
