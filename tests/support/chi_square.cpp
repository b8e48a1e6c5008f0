// SPDX-License-Identifier: Apache-2.0
#include "support/chi_square.h"

#include <cmath>
#include <numeric>

namespace orrery::test {

ChiSquare chi_square_of_equal_bins(const std::vector<std::uint64_t>& counts) {
  const double total = static_cast<double>(std::accumulate(counts.begin(), counts.end(), std::uint64_t{0}));
  const double expected = total / static_cast<double>(counts.size());
  ChiSquare out;
  for (const std::uint64_t count : counts) {
    const double difference = static_cast<double>(count) - expected;
    out.statistic += difference * difference / expected;
  }
  const double degrees = static_cast<double>(counts.size()) - 1;
  const double spread = 2 / (9 * degrees);
  out.z = (std::cbrt(out.statistic / degrees) - (1 - spread)) / std::sqrt(spread);
  return out;
}

}  // namespace orrery::test
