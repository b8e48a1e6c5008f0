// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "accel/forward.h"
#include "accel/traversal.h"
#include "compile/forward.h"

namespace orrery::render {

/// Chooses the BVH traversal for a scene.
///
/// Unless a traversal is requested, up to 0.2 % of the image's paths are rendered and the tracing of their rays is
/// timed with both traversals. If the image has too few paths for that to pay off, the number of spheres decides.
/// Hits, and with them the image, do not depend on the choice.
accel::Traversals choose_traversals(const compile::CompiledScene& compiled, accel::Accel& accel,
                                    std::optional<accel::Traversal> requested);

/// Describes the traversal before anything is built: "packet", "single", "list", or that a trial will choose.
std::string planned_traversal(const compile::CompiledScene& compiled);

/// Name of the traversals, e.g. "packet" or "packet, secondary single".
std::string name_of(accel::Traversals traversals);

}  // namespace orrery::render
