// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "accel/accel.h"
#include "compile/compiled_scene.h"
#include "render/render.h"

namespace orrery::render {

/// How the rays of a world had best go through its hierarchy.
///
/// Unless one is requested, some thousandths of the picture's paths are rendered, and their rays traced both ways
/// against the clock; where the picture has too few paths for that to pay, the number of spheres decides. Hits do not
/// depend on the choice, so neither does the picture.
accel::Traversals choose_traversals(const compile::CompiledScene& compiled, accel::Accel& accel,
                                    std::optional<accel::Traversal> requested);

/// What can be said before anything is built: "packet" and the like, "list", or that a trial will choose.
std::string planned_traversal(const compile::CompiledScene& compiled);

/// "packet", "single", "packet, bounced single".
std::string name_of(accel::Traversals traversals);

}  // namespace orrery::render
