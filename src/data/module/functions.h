// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "data/data_file.h"

namespace orrery::data {

/// The public functions of this room that need third-party libraries. They are in a module that the program loads at
/// the first call.
struct Functions {
  decltype(&data::open) open;
};

}  // namespace orrery::data
