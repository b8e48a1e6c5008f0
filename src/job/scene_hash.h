// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "compile/forward.h"

namespace orrery::job {

/// Hash of everything that determines the image, as sixteen hexadecimal digits: spheres, materials, lights, camera,
/// background, samples, seed. Excludes names, comments and the accelerator, which change no bit of the image. Not
/// cryptographic.
///
/// Reference  fnv
std::string scene_hash(const compile::CompiledScene& compiled);

/// The same hash of a text.
std::string text_hash(std::string_view text);

}  // namespace orrery::job
