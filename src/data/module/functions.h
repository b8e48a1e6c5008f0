// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "data/data_file.h"
#include "data/write_table.h"

namespace orrery::data {

/// The public functions of this room. They need third-party libraries and are therefore in a module that the program
/// loads on the first call.
struct Functions {
  decltype(&data::open) open;
  decltype(&data::is_data_file) is_data_file;
  decltype(&data::require_table_format) require_table_format;
  decltype(&data::is_storable_in_ply) is_storable_in_ply;
  decltype(&data::write_table) write_table;
};

}  // namespace orrery::data
