// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "compile/forward.h"
#include "scene/forward.h"

namespace orrery::compile {

/// Compiles the authored scene into flat arrays and determines the features that it requires.
///
/// A negative radius becomes a positive one with the material turned inside out, angles become vectors, and unused
/// materials are left out.
///
/// A sky that is not baked yet is baked, in linear Rec.709; load::load_scene bakes it for other working spaces.
///
/// `closing`  the scene at shutter close, without points; null: no motion blur. What does not move costs nothing.
/// Domain     scenes in which scene::validate finds no error
CompiledScene compile(const scene::Scene& scene, const scene::Scene* closing = nullptr);

/// Builds the light tree, if the scene samples its emitters. Needed after a change of `precision`, since other spheres
/// may coincide in another number type, and of `direct_lighting`.
///
/// Cost       that of build_light_tree; none if the tree would be the same
void update_lights(CompiledScene& scene);

/// Returns the number of index bits that count a pixel's samples when blue noise shares a sequence among neighbours.
int blue_noise_bits(int samples) noexcept;

}  // namespace orrery::compile
