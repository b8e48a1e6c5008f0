// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "compile/compiled_scene.h"
#include "scene/scene.h"

namespace orrery::bench {

/// The book's random final scene, as in scenes/book/final.toml except for the image size and sample count.
scene::Scene final_scene(int width_px, int height_px, int samples);

/// Small floating spheres, as made by `orrery generate cloud`. Their size decreases with `count`, so that coverage of
/// the image stays about the same.
scene::Scene cloud_scene(std::uint64_t count, int width_px, int height_px, int samples);

/// The final scene with a grid of (2 grid)^2 small spheres: a thin layer.
scene::Scene layer_scene(int grid, int width_px, int height_px, int samples);

/// A face-centred cubic crystal of 4 cells^3 matte spheres that nearly touch, in white light.
scene::Scene crystal_scene(int cells, int width_px, int height_px, int samples);

/// Compiles the scene for one precision.
compile::CompiledScene compile_for(scene::Scene scene, kernel::Precision precision);

/// The precision's name in benchmark names, as in scene files.
std::string name_of(kernel::Precision precision);

}  // namespace orrery::bench
