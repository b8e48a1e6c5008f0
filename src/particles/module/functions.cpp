// SPDX-License-Identifier: Apache-2.0
// The module's side: compiled into the module together with the room.
#include "particles/module/functions.h"

namespace orrery::particles {

using namespace data;  // NOLINT(google-build-using-namespace)

extern "C" const void* orrery_particles_functions() {
  static constexpr Functions functions{open, is_data_file, table_format, write_table};
  return &functions;
}

}  // namespace orrery::particles
