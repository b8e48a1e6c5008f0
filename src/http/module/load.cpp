// SPDX-License-Identifier: Apache-2.0
// The program's side of the module: forwards the room's functions to the module and loads it on the first call, so that
// only `orrery view` loads libmicrohttpd.
#include "base/module.h"
#include "http/module/functions.h"

namespace orrery::http {

Server serve(const std::string& address, int port, Admission admits, Handler handler) {
  static const Functions& functions = *static_cast<const Functions*>(base::load_module("http"));
  return functions.serve(address, port, std::move(admits), std::move(handler));
}

}  // namespace orrery::http
