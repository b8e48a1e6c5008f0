// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "compile/world.h"
#include "scene/scene.h"

namespace orrery::bench {

/// The random final scene of the book, as scenes/book/final.toml has it but for the size.
scene::Scene final_scene(int width_px, int height_px, int samples);

/// Small spheres in the air, as `orrery generate cloud` makes them: the larger `count`, the smaller they are, so that
/// the picture stays about as full.
scene::Scene cloud_scene(std::uint64_t count, int width_px, int height_px, int samples);

/// The scene, compiled for one precision.
compile::World compile_for(scene::Scene scene, kernel::Precision precision);

/// The precision's name in the name of a benchmark, the same as in a scene file.
std::string name_of(kernel::Precision precision);

}  // namespace orrery::bench
