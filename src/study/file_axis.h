// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "film/forward.h"

namespace orrery::study {

struct FilePoint;

/// Measures size, write time and error of an image as EXR, in half and float with each compression.
///
/// Errors     base::Error: kCannotCreate, kIo
std::vector<FilePoint> measure_file_axis(const film::Picture& picture);

}  // namespace orrery::study
