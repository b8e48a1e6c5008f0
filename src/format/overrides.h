// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <toml++/toml.h>

#include <string>
#include <vector>

#include "format/diagnostics.h"
#include "format/override.h"
#include "format/source_text.h"

namespace orrery::format {

/// Applies overrides to the tree of a scene file: "camera.vfov=30", "render.precision=fast",
/// "material.\"my gold\".fuzz=0.3", "sphere[2].radius=0.5", "output.layers=[Z,N]". The locations of the new nodes are
/// those in the override.
///
/// A value is TOML; words and lists of words need no quotes. Missing tables are created; list elements must exist.
void apply_overrides(toml::table& root, const std::vector<Override>& overrides, SourceText& source,
                     Diagnostics& diagnostics);

}  // namespace orrery::format
