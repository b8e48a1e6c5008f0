// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "app/generate.h"

namespace orrery::app {

/// Writes a generated scene, with a comment that tells the command which makes it again.
///
/// Errors     base::Error: kUsage, kCannotCreate, kIo
void generate_final(const FinalScene& options, const std::filesystem::path& file);

/// The same; the spheres go to a PLY file beside it.
void generate_cloud(const Cloud& options, const std::filesystem::path& file);

}  // namespace orrery::app
