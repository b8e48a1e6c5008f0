// SPDX-License-Identifier: Apache-2.0
// The module's side: compiled into the module together with the room.
#include "formats/module/functions.h"

namespace orrery::formats {

using namespace data;  // NOLINT(google-build-using-namespace)

extern "C" const void* orrery_formats_functions() {
  static constexpr Functions functions{open, is_data_file, table_format, write_table};
  return &functions;
}

}  // namespace orrery::formats
