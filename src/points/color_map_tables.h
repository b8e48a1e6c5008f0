// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

namespace orrery::points {

/// A knot of a colour map: index in its published table of 256 entries, and display-referred sRGB.
struct ColorMapRow {
  std::uint8_t index;
  double r, g, b;
};

struct ContinuousTable {
  const char* name;
  std::span<const ColorMapRow> rows;
};

struct CategoricalTable {
  const char* name;
  std::span<const std::uint32_t> colors;  ///< 0xRRGGBB
};

extern const std::span<const ContinuousTable> kContinuousTables;
extern const std::span<const CategoricalTable> kCategoricalTables;

}  // namespace orrery::points
