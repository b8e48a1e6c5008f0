// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

namespace orrery::test {

/// How far counts lie from what was expected.
struct ChiSquare {
  double statistic = 0;
  double z = 0;  ///< about a standard normal number where the expectation is right (Wilson and Hilferty's cube root)
};

/// Pearson's test of counts against equally likely bins.
///
/// Reference  wilson1931
ChiSquare chi_square_of_equal_bins(const std::vector<std::uint64_t>& counts);

/// Beyond this |z| a right sampler is condemned once in ten million tests; the suite has some dozen.
inline constexpr double kLargestZ = 5.2;

}  // namespace orrery::test
