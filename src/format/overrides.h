// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <toml++/toml.h>

#include <string>
#include <vector>

#include "base/finding.h"
#include "format/source_text.h"

namespace orrery::format {

/// The name of the text that all overrides together are, a line each, in the place of a file's name.
inline constexpr const char* kOverrideName = "--set";

/// Puts "key=value" texts into a scene's tree, as if they stood in its file: "camera.vfov=30", "render.precision=fast",
/// "material.\"my gold\".fuzz=0.3", "sphere[2].radius=0.5". Keys and values get their places in the override.
///
/// A value is TOML, or a word without quotes. Tables on the way are made; elements of lists must be there.
void apply_overrides(toml::table& root, const std::vector<std::string>& overrides, SourceText& source,
                     std::vector<base::Finding>& findings);

}  // namespace orrery::format
