// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "compile/compiled_scene.h"

namespace orrery::job {

/// Sixteen hexadecimal digits that name what is rendered: spheres, materials, camera, background, samples, seed. Not
/// names, comments or the accelerator, which change no bit of the picture. It identifies; it protects from nobody.
///
/// Reference  fnv
std::string scene_hash(const compile::CompiledScene& compiled);

/// The same of a text.
std::string text_hash(std::string_view text);

}  // namespace orrery::job
