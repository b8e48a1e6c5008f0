// SPDX-License-Identifier: Apache-2.0
#include "support/chi_square.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace orrery::test {

ChiSquare chi_square_of_equal_bins(const std::vector<std::uint64_t>& counts) {
  const double total = static_cast<double>(std::accumulate(counts.begin(), counts.end(), std::uint64_t{0}));
  return chi_square(counts, std::vector<double>(counts.size(), total / static_cast<double>(counts.size())));
}

ChiSquare chi_square(const std::vector<std::uint64_t>& counts, const std::vector<double>& expected) {
  constexpr double kMinExpectedCount = 5;
  ChiSquare out;
  double bins = 0, pooled = 0, pooled_expected = 0;
  const auto add = [&](double count, double expectation) {
    out.statistic += (count - expectation) * (count - expectation) / expectation;
    ++bins;
  };
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (expected[i] >= kMinExpectedCount) {
      add(static_cast<double>(counts[i]), expected[i]);
    } else {
      pooled += static_cast<double>(counts[i]);
      pooled_expected += expected[i];
    }
  }
  // Counts where none can be must not vanish in a division by zero.
  if (pooled > 0 || pooled_expected >= kMinExpectedCount) add(pooled, std::max(pooled_expected, 1e-3));
  const double degrees = bins - 1;
  const double spread = 2 / (9 * degrees);
  out.z = (std::cbrt(out.statistic / degrees) - (1 - spread)) / std::sqrt(spread);
  return out;
}

}  // namespace orrery::test
