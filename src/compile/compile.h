// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "compile/forward.h"
#include "kernel/rod.h"
#include "kernel/sphere.h"
#include "scene/changed_parts.h"
#include "scene/scene.h"

namespace orrery::compile {

/// Compiles the authored scene into flat arrays and determines the features that it requires.
///
/// A negative radius becomes a positive one with the material turned inside out, angles become vectors, and unused
/// materials are dropped.
///
/// A sky that is not yet baked is baked in linear Rec.709; load::load_scene bakes it for other working spaces.
///
/// `closing`  the scene at shutter close, without data; null: no motion blur. Static objects cost nothing.
/// Domain     scenes in which scene::validate finds no error
CompiledScene compile(const scene::Scene& scene, const scene::Scene* closing = nullptr);

/// Compiles again the parts of a compiled scene that a change of the authored scene affects. The result is that of
/// compile(), and what has not changed keeps its address: a BVH of the spheres stays valid unless `changed.geometry`.
///
/// `changed`  a superset of what has changed since `compiled` was compiled or updated
/// Domain     the points tables of `scene` have their spheres if `changed` contains geometry or assignment
void update(const scene::Scene& scene, const scene::Scene* closing, scene::Parts changed, CompiledScene& compiled);

/// The same, and releases the centres of the points tables as they are compiled, so that there is no second copy of
/// them. Those of `scene` are indeterminate from then on.
void update_and_release(scene::Scene& scene, const scene::Scene* closing, scene::Parts changed,
                        CompiledScene& compiled);

/// The change of the spheres, up to the last that moves.
///
/// `other`    the scene at another time, without data
/// `frames`   the time between the two, frames
/// Domain     the centres of `scene` are not released
std::vector<kernel::Sphere> sphere_motion(const scene::Scene& scene, const scene::Scene& other, double frames);

/// The same of the rods, except bonds that are not stubs, with ends in the order of those of `scene`.
std::vector<kernel::Rod> rod_motion(const scene::Scene& scene, const scene::Scene& other, double frames);

/// Finds objects that coincide, and builds the light tree and the list of caustics, if the scene samples its lights.
/// Needed after a change of `precision`, since others may coincide in another number type, of `direct_lighting` and
/// `samples_caustics`.
///
/// Cost       those of coincident_objects and build_light_tree, unless the results would be the same; that of
///            caustic_list
void update_lights(CompiledScene& scene);

/// Returns the number of index bits that count a pixel's samples when neighbouring pixels share a blue-noise sequence.
int blue_noise_bits(int samples) noexcept;

}  // namespace orrery::compile
