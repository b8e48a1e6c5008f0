// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "http/server.h"

namespace orrery::http {

/// The public functions of this room. They need libmicrohttpd and are therefore in a module that the program loads on
/// the first call.
struct Functions {
  decltype(&http::serve) serve;
};

}  // namespace orrery::http
