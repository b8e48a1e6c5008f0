// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "scene/value_text.h"

namespace orrery::scene {

/// A number or vector of the scene that a track can animate.
struct Animated {
  ValueType type;  ///< kNumber or kVector
  Range range;
  std::function<void(Scene&, const Value&)> set;
};

/// Finds the number or vector that a target names: "camera.look_from", "background.top", "sphere[3].center",
/// "sphere.NAME.radius", "rod[0].from", "material.NAME.albedo".
///
/// Result     nullopt if the scene has no such target
std::optional<Animated> find_animated(const Scene& scene, const std::string& target);

/// Returns the targets by index, such as "sphere[3].radius", of the spheres or rods that a target matches; several if
/// they share a name. Empty for other targets.
std::vector<std::string> indexed_targets(const Scene& scene, const std::string& target);

/// Returns all targets that find_animated accepts in this scene, except those with an index.
std::vector<std::string> animated_names(const Scene& scene);

/// Returns the value of a track at a frame, which may be fractional. It is constant before the first key and after the
/// last one.
///
/// Domain     ascending frames, as many values as frames, at least one
/// Reference  catmull1974 for cubic tracks, generalised to unevenly spaced keys
Vec3d value_at(const Track& track, double frame);

/// Returns the scene at a frame: applies the tracks, then the turntable.
///
/// Domain     tracks whose targets exist
Scene posed(const Scene& scene, double frame);

}  // namespace orrery::scene
