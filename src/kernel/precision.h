// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace orrery::kernel {

/// How a ray meets a sphere; docs/numerics.md has the error and the price of each.
enum class Precision : std::uint8_t {
  kExact,  ///< double, perpendicular form with the low part of the difference, root exclusion
  kFast,   ///< float, perpendicular form, root exclusion
  kBook,   ///< the book's quadratic in double with t_min, faithful to its failures
};

/// The book's t_min, in scene units since directions are unit vectors.
inline constexpr double kBookShortestDistance = 0.001;

}  // namespace orrery::kernel
