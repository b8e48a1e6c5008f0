// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "formats/open.h"
#include "formats/write_table.h"

namespace orrery::formats {

/// The public functions of this room. They need third-party libraries and are therefore in a module that the program
/// loads on the first call.
struct Functions {
  decltype(&formats::open) open;
  decltype(&formats::is_data_file) is_data_file;
  decltype(&formats::table_format) table_format;
  decltype(&formats::write_table) write_table;
};

}  // namespace orrery::formats
