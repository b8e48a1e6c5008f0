// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "accel/accel.h"
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

/// Builds the scene's spheres as Embree user geometry.
///
/// A BVH of many spheres pays off in clouds, one primitive per sphere in layers of spheres seen in coherent packets. Up
/// to a hundred thousand spheres, both are therefore built, and the faster one in a trial of the scene's rays is kept,
/// as in choose_traversals(). Hits, and with them the image, do not depend on the choice.
///
/// Errors     those of accel::make_embree()
std::unique_ptr<accel::Accel> build_embree(const compile::CompiledScene& compiled, const accel::BuildMonitor& monitor);

/// Describes the traversal before anything is built: "packet", "single", "list", or that a trial will choose.
std::string planned_traversal(const compile::CompiledScene& compiled);

/// Name of the traversals, e.g. "packet" or "packet, secondary single".
std::string name_of(accel::Traversals traversals);

}  // namespace orrery::render
