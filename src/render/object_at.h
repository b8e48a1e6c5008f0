// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "accel/accel.h"
#include "compile/forward.h"

namespace orrery::render {

/// The sphere or the rod that is visible at a point of the image, when the shutter opens and without the blur of the
/// lens.
///
/// `accel`    of the spheres of `scene`
/// `x`, `y`   px from the upper left corner of the rendered window
/// Result     the id of a hit; with opacities, of the object that contributes most to the point; empty if only the
///            background is visible
std::optional<std::uint32_t> object_at(const compile::CompiledScene& scene, const accel::Accel& accel, double x,
                                       double y);

}  // namespace orrery::render
