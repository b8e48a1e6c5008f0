// SPDX-License-Identifier: Apache-2.0
// The module's side: compiled into the module together with the room.
#include "http/module/functions.h"

namespace orrery::http {

extern "C" const void* orrery_http_functions() {
  static constexpr Functions functions{serve};
  return &functions;
}

}  // namespace orrery::http
