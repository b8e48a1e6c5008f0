// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "data/data_file.h"

/// The formats that this room reads, each defined in a file of its own. Used only by particles::open().
namespace orrery::rows {

extern const data::FormatReader kLammpsDump, kLammpsData, kXyz, kPly, kCsv;

/// CSV, as selected by the extension alone.
extern const data::FormatReader kNamedCsv;

}  // namespace orrery::rows
