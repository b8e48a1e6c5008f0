// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "compile/world.h"

namespace orrery::app {

/// Sixteen hexadecimal digits that name what is rendered: spheres, materials, camera, background, samples, seed. Not
/// names, comments or the accelerator, which change no bit of the picture. It identifies; it protects from nobody.
///
/// Reference  fnv
std::string scene_hash(const compile::World& world);

}  // namespace orrery::app
