// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "data/forward.h"

namespace orrery::points {

class Rows;

/// Returns rows ascending by particle id; rows with equal ids keep their order, and those without an id are last.
///
/// `selected`  ascending; empty: all rows
/// `repeated`  receives the number of rows with the same id as the preceding row in this order
/// Cost        one pass if the ids ascend, or are 1 to N in any order; else a sort
Rows rows_by_id(const data::Column& ids, std::vector<std::uint32_t> selected, std::size_t& repeated);

}  // namespace orrery::points
