// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "data/table.h"
#include "points/rows.h"

namespace orrery::points {

/// Returns rows ascending by particle id; rows with equal ids keep their order, and those without an id are last.
///
/// `selected`  ascending; empty: all rows
/// Cost        one pass if the ids ascend, or are 1 to N in any order; else a sort
Rows rows_by_id(const data::Column& ids, std::vector<std::uint32_t> selected);

}  // namespace orrery::points
