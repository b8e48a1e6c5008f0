// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/scene.h"

namespace orrery::scene {

/// What a key of the scene changes in a scene that is prepared for rendering.
enum class Part {
  kGeometry,    ///< the spheres, and with them the BVH
  kAssignment,  ///< which material, colour or opacity each sphere has
  kLook,        ///< materials, colours, textures, background, lights
  kView,        ///< camera, image, filter, sampling
  kOutput,      ///< nothing that is rendered: names, layers, the display transform
};

/// A set of parts.
struct Parts {
  bool geometry = false, assignment = false, look = false, view = false, output = false;

  static constexpr Parts all() { return {true, true, true, true, true}; }
  bool any() const { return geometry || assignment || look || view || output; }
  void add(Part part);
};

/// Returns the parts in which two authored scenes differ, as the schema says of each key. The spheres of points tables
/// are not compared, only their keys.
///
/// `closing_before`, `closing_after`  the scenes at shutter close; null: no motion blur
/// Cost       linear in the number of [[sphere]] tables and materials
Parts changed_parts(const Scene& before, const Scene* closing_before, const Scene& after, const Scene* closing_after);

}  // namespace orrery::scene
