// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "scene/scene.h"
#include "scene/schema.h"

namespace orrery::scene {

/// A number or vector of a scene that may change from frame to frame.
struct Animated {
  ValueType type;  ///< kNumber or kVector
  Range range;
  std::function<void(Scene&, const Value&)> set;
};

/// Finds what "camera.look_from", "background.top", "sphere[3].center", "sphere.NAME.radius" or "material.NAME.albedo"
/// names; nothing where the scene has no such number.
std::optional<Animated> find_animated(const Scene& scene, const std::string& target);

/// The spheres that a target may mean, by number: several where they share its name. Empty for other targets.
std::vector<std::size_t> spheres_of_target(const Scene& scene, const std::string& target);

/// All names that find_animated knows in this scene, of spheres only those that have names.
std::vector<std::string> animated_names(const Scene& scene);

/// As they stand in files, in the order of the enumerators.
const std::vector<std::string>& interpolation_names();

/// The value of a track at a frame, which need not be whole. Before the first key and behind the last one it rests.
///
/// Domain     frames ascend, as many values as frames, at least one
/// Reference  catmull1974 for cubic tracks, whose keys need not be evenly spaced
Vec3d value_at(const Track& track, double frame);

/// The scene as it stands at a frame: tracks, then the turntable.
///
/// Domain     tracks whose targets are known
Scene posed(const Scene& scene, double frame);

}  // namespace orrery::scene
