// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "particles/open.h"
#include "particles/write_table.h"

namespace orrery::particles {

/// The public functions of this room. They need third-party libraries and are therefore in a module that the program
/// loads on the first call.
struct Functions {
  decltype(&particles::open) open;
  decltype(&particles::is_data_file) is_data_file;
  decltype(&particles::table_format) table_format;
  decltype(&particles::write_table) write_table;
};

}  // namespace orrery::particles
