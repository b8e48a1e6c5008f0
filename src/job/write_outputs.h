// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "display/forward.h"
#include "film/forward.h"
#include "image/forward.h"
#include "job/matte_names.h"

namespace orrery::job {

struct Outputs;

/// Checks that the display formats among the outputs have enough bits per channel for the display.
///
/// Errors     base::Error(kUsage)
void require_bits(const display::Choice& display, const Outputs& outputs);

/// Writes the files of an image, and the manifests of its mattes.
///
/// `bits`     bits per channel of display formats
/// Errors     base::Error: kCannotCreate, kIo; those of display::develop
image::WriteReport write_outputs(const Outputs& outputs, const display::Settings& display, int bits,
                                 const film::Picture& picture, const image::Header& header,
                                 const std::vector<MatteNames>& mattes);

}  // namespace orrery::job
