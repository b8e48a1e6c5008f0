// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "compile/compiled_scene.h"
#include "scene/scene.h"

namespace orrery::compile {

/// Turns the authored scene into flat arrays and finds out what it requires.
///
/// Authored meaning ends here: a negative radius becomes a positive one with the material turned inside out, degrees
/// become vectors, and materials that no sphere uses are left out.
///
/// `closing`  what the shutter closes on, without points; null: it is never open. What then turns out not to move costs
///            nothing.
/// Domain     scenes that scene::validate finds no error in
CompiledScene compile(const scene::Scene& scene, const scene::Scene* closing = nullptr);

/// Bits that count a pixel's samples where blue noise shares a sequence among neighbours.
int blue_noise_bits(int samples) noexcept;

}  // namespace orrery::compile
