// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

namespace orrery::test {

/// Result of a chi-square test.
struct ChiSquare {
  double statistic = 0;
  double z = 0;  ///< approximately standard normal under the null hypothesis (Wilson-Hilferty cube root)
};

/// Pearson's chi-square test of counts in equally likely bins.
///
/// Reference  wilson1931
ChiSquare chi_square_of_equal_bins(const std::vector<std::uint64_t>& counts);

/// Pearson's test of counts against expected counts. Bins with fewer than five expected counts are pooled.
///
/// Domain     both of the same length and with the same sum
ChiSquare chi_square(const std::vector<std::uint64_t>& counts, const std::vector<double>& expected);

/// Threshold on |z|. A correct sampler exceeds it once in ten million tests; the suite has a few dozen.
inline constexpr double kLargestZ = 5.2;

}  // namespace orrery::test
