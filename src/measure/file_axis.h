// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "film/picture.h"
#include "measure/study.h"

namespace orrery::measure {

/// Writes a picture as EXR in half and float and with each compression, in a folder for temporary files, and reads it
/// back.
///
/// Errors     base::Error: kCannotCreate, kIo
std::vector<FilePoint> measure_file_axis(const film::Picture& picture);

}  // namespace orrery::measure
