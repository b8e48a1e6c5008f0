// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "data/data_file.h"
#include "data/write_table.h"

namespace orrery::data {

/// The public functions of this room, which needs third-party libraries. They are in a module that the program loads at
/// the first call.
struct Functions {
  decltype(&data::open) open;
  decltype(&data::table_format) table_format;
  decltype(&data::write_table) write_table;
};

}  // namespace orrery::data
