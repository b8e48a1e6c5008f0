// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace orrery::kernel {

/// The arithmetic of the ray-sphere intersection; docs/numerics.md has the error and the cost of each.
enum class Precision : std::uint8_t {
  kExact,  ///< double, compensated perpendicular form, root exclusion
  kFast,   ///< float, perpendicular form, root exclusion
  kBook,   ///< the book's quadratic in double with t_min, including its failures
};

/// The book's t_min, scene units (directions are unit vectors).
inline constexpr double kBookShortestDistance = 0.001;

}  // namespace orrery::kernel
