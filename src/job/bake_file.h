// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "display/bake.h"
#include "display/settings.h"

namespace orrery::job {

/// Writes a display transform as a .cube or .clf file for other programs.
///
/// Errors     those of display::choose; base::Error: kUsage for another extension, kCannotCreate, kIo
void bake_file(const display::Settings& display, int cube_size, const std::filesystem::path& file);

}  // namespace orrery::job
