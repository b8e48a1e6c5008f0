// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "compile/forward.h"

namespace orrery::info {

/// Returns the number of emitters that are rendered, without those that are black. Of coincident spheres, only the
/// first is rendered.
std::uint64_t count_emitters(const compile::CompiledScene& compiled);

/// Describes how light is sampled: "40 emitters; light and BSDF sampling; emitters by a light tree of 1.9 KiB". Empty
/// without emitters and image background.
///
/// `count`    number of emitters
std::string lights_text(const compile::CompiledScene& compiled, std::uint64_t count);

}  // namespace orrery::info
