// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

namespace orrery::app {

/// Finds out everything about pictures to write that can be known to fail before hours are spent: unknown extensions,
/// more bits than a format holds, a name that is given twice or that is an input, directories that take no file.
///
/// Domain     `bits` of display formats, 0: nobody asked; `others` are files to write that are no pictures
/// Errors     base::Error: kUsage, kCannotCreate
void check_output_files(const std::vector<std::filesystem::path>& pictures, int bits,
                        const std::vector<std::filesystem::path>& others,
                        const std::vector<std::filesystem::path>& inputs);

}  // namespace orrery::app
