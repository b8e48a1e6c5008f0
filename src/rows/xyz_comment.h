// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "data/faults.h"
#include "data/table.h"

namespace orrery::rows {

/// The values in the second line of a frame of extended XYZ, by key. Quotes and brackets around a value are removed; a
/// key without a value maps to an empty string.
using XyzValues = std::map<std::string, std::string, std::less<>>;

XyzValues xyz_values(std::string_view line);

/// A property of the atoms: one column or several.
struct XyzProperty {
  std::string name;
  data::ColumnType type = data::ColumnType::kFloat64;
  std::size_t count = 1;
};

/// Parses "species:S:1:pos:R:3".
///
/// Errors     base::Error(kBadData), thrown through `faults`
std::vector<XyzProperty> xyz_properties(std::string_view text, std::uint64_t line, data::Faults& faults);

/// Reads `Lattice`, `pbc` and `Origin`.
///
/// Result     empty without a lattice
/// Errors     base::Error(kBadData), thrown through `faults`
std::optional<data::Box> xyz_box(const XyzValues& values, std::uint64_t line, data::Faults& faults);

}  // namespace orrery::rows
