// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "display/develop.h"

namespace orrery::app {

/// Develops a picture on disk for a display, into every output.
///
/// Errors     base::Error of every kind; kUsage for an output that is no display format
void develop_file(const std::filesystem::path& input, const std::vector<std::filesystem::path>& outputs,
                  const display::Settings& settings, int bits);

}  // namespace orrery::app
