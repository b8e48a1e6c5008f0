// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "generate/generate.h"

namespace orrery::generate {

/// Writes a generated scene: TOML to `file`, bulk spheres beside it to the same name with .ply for an extension.
///
/// A comment at the head says what it shows and which command makes it again, the same byte for byte.
///
/// A points file is replaced only where orrery made it.
///
/// Errors     base::Error: kUsage for options outside their range and for a `file` that itself ends in .ply;
///            kCannotCreate before anything is generated, also for a points file of other origin; kIo
void generate_final(const FinalScene& options, const std::filesystem::path& file);
void generate_cloud(const Cloud& options, const std::filesystem::path& file);

}  // namespace orrery::generate
