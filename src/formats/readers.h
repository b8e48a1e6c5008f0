// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "data/data_file.h"

/// The formats that are read, each defined in a separate file. Used only by open().
namespace orrery::formats {

extern const data::FormatReader kLammpsDump, kLammpsData, kXyz, kPly, kCsv;
extern const data::FormatReader kNpy, kNpz, kLas, kGsd, kHdf5, kVtk;
extern const data::FormatReader kPdb, kMmcif;

/// CSV, as selected by the extension alone.
extern const data::FormatReader kNamedCsv;

}  // namespace orrery::formats
