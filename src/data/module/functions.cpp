// SPDX-License-Identifier: Apache-2.0
// The module's side: compiled into the module together with the room.
#include "data/module/functions.h"

namespace orrery::data {

extern "C" const void* orrery_data_functions() {
  static constexpr Functions functions{open, is_data_file, require_table_format, is_storable_in_ply, write_table};
  return &functions;
}

}  // namespace orrery::data
