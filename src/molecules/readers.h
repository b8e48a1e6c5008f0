// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "data/data_file.h"

/// The formats that this room reads, each defined in a file of its own. Used only by particles::open().
namespace orrery::molecules {

extern const data::FormatReader kPdb, kMmcif;

}  // namespace orrery::molecules
