// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "kernel/camera.h"
#include "kernel/caustics.h"
#include "kernel/lights.h"
#include "kernel/material.h"
#include "kernel/pixel_sum.h"
#include "kernel/rod.h"
#include "kernel/seen_emitters.h"
#include "kernel/sphere.h"
#include "math/vec3.h"

namespace orrery::kernel {

/// Background radiance: bottom + (top - bottom) (h + 1) / 2 for a ray that leaves the scene, where h is the component
/// of its unit direction along `up`.
struct Background {
  math::Vec3d bottom{1, 1, 1};
  math::Vec3d top{1, 1, 1};
  math::Vec3d up{0, 1, 0};  ///< unit
};

/// The share of the background in the colour of a path's first hit, at a depth of z along the view axis: `slope` z -
/// `offset`, clamped to 0..`strength`.
struct DepthCue {
  double strength = 0;
  double offset = 0;
  math::Vec3d slope;  ///< along the view axis, 1 / scene units

  /// The share at a depth, scene units.
  double share(double z) const { return std::fmax(0, std::fmin(math::length(slope) * z - offset, strength)); }
};

/// Radiance that a material emits in all directions. An array, so that the kernel can gather the members as four
/// doubles.
struct Emission {
  double radiance[3] = {0, 0, 0};  ///< scene-linear
  double group = 0;                ///< light group, an integer; 0: the default group
};

enum class Shading : std::uint8_t { kPath, kNormal, kFlat };

/// Features that the scene uses; the kernel skips those that are false. Only features whose absence saves time have a
/// bit. Materials need none: the kernel skips a material that no lane of a vector has hit
/// (docs/decisions/0012-two-path-loops-few-feature-bits.md).
struct Features {
  bool lens = false;            ///< the camera has an aperture
  bool hemisphere = false;      ///< some sphere has a hemisphere material
  bool gradient = false;        ///< the background depends on the direction
  bool tilted = false;          ///< the gradient rises in another direction than +y
  bool motion = false;          ///< camera or spheres move while the shutter is open
  bool lit = false;             ///< something emits, or is sampled: paths gain radiance at their vertices
  bool rich_materials = false;  ///< textures, rough glass or plastic
  bool rods = false;            ///< there are rods
  bool opacity = false;         ///< some opacity is below 1
  bool caustics = false;        ///< images of lights in balls are sampled
  bool depth_cue = false;       ///< first hits fade into the background
};

/// Reciprocal of the throughput below which Russian roulette may end a path. Ending paths of higher throughput would
/// add more noise than the saved time is worth.
inline constexpr double kRouletteGain = 8;

/// A roulette depth that no path reaches.
inline constexpr std::uint32_t kNoRoulette = 0xffffffffu;

/// What is not an array: camera, background, and how paths are sampled.
struct SceneSettings {
  DirectLighting direct_lighting = DirectLighting::kMis;
  Camera camera;
  Camera camera_motion;  ///< change of the camera's vectors until the shutter closes, if features.motion
  // If features.depth_cue:
  DepthCue depth_cue;
  DepthCue page_fade;  ///< that of SceneView::page
  Background background;
  Features features;
  Shading shading = Shading::kPath;
  std::uint32_t max_depth = 50;                ///< maximum rays per path, including the camera ray
  std::uint32_t roulette_depth = kNoRoulette;  ///< scattering events after which Russian roulette begins
  Sampler sampler;
};

/// Non-owning view of the compiled scene for the kernel.
struct SceneView : SceneSettings {
  SphereArray spheres;          ///< at least one can be read, even if there are only rods
  IndexArray object_materials;  ///< index into `materials` of each sphere, then of each half of each rod
  const Material* materials = nullptr;
  std::size_t sphere_count = 0;
  RodArray rods;  ///< ids follow those of the spheres
  /// Numbers (RodArray::object) of objects that coincide with an earlier one, ascending. Rays do not hit them:
  /// exclusion is by the id of what a ray leaves or leads to, and the other one would be hit a few rounding errors
  /// away.
  std::span<const std::uint32_t> duplicates;
  /// Probability, 0..1, that each sphere, then each half of each rod, is visible to a ray; null: all are 1.
  const float* opacity = nullptr;
  const Emission* emission = nullptr;  ///< one per material; null if nothing emits
  /// Textures, and one entry per material; null if there are none. The constants that they replace are set to the
  /// textures' means.
  const Texture* textures = nullptr;
  const MaterialTextures* material_textures = nullptr;
  /// Width of ray cones as a fraction of pixel, lens and lobe; 0: no texture has levels, so that paths have no cones.
  double cone_width = 0;
  Lights lights;      ///< the emitters that light sampling chooses from
  Caustics caustics;  ///< empty unless features.caustics
  SeenEmitters seen_emitters;
  /// Change in centre and radius of each of the first `moving_count` spheres, from shutter open to shutter close; null:
  /// none.
  const Sphere* motion = nullptr;
  std::size_t moving_count = 0;
  const Environment* environment = nullptr;  ///< an image background, which replaces `background`; null: none
  PixelFilter filter;
  /// Origin of the rendered window within the frame, modulo 65536. A pixel's random numbers depend on its position in
  /// the frame, so a window's pixels equal those of the full frame.
  std::uint32_t window_x = 0, window_y = 0;
  bool background_visible = true;  ///< false: camera rays that leave the scene carry no radiance
  bool has_backdrop = false;       ///< camera rays that leave the scene carry `backdrop`, not the background's radiance
  math::Vec3d backdrop{0, 0, 0};
  /// A sphere that is a part of the backdrop for camera rays: it does not cover them. If the background is invisible,
  /// its radiance is not that of the pixel, but what it lacks compared to the backdrop is coverage. kNone: there is
  /// none.
  std::uint32_t page = kNone;

  /// Whether the object with this id coincides with an earlier one.
  bool is_duplicate(std::uint32_t id) const noexcept {
    return std::binary_search(duplicates.begin(), duplicates.end(), rods.object(id));
  }
};

/// A sphere at a time between 0 (shutter opens) and 1 (shutter closes), computed like in the kernel's loops.
inline Sphere sphere_at(const SceneView& scene, std::size_t id, double time) noexcept {
  Sphere s = scene.spheres[id];
  if (id >= scene.moving_count) return s;
  const Sphere& change = scene.motion[id];
  s.x = std::fma(change.x, time, s.x);
  s.y = std::fma(change.y, time, s.y);
  s.z = std::fma(change.z, time, s.z);
  s.radius = std::fma(change.radius, time, s.radius);
  return s;
}

/// Converts a pixel id, y << 16 | x within the frame, to coordinates within the rendered window. No side of an image
/// exceeds 65536.
inline PixelPlace place_of(std::uint64_t name, const SceneView& scene) noexcept {
  return {static_cast<int>((name - scene.window_x) & 0xffff),
          static_cast<int>(((name >> 16) - scene.window_y) & 0xffff)};
}

/// The bounding sphere of half of a rod, which encloses its whole motion, and its power but for the radiance: as that
/// of a sphere, in proportion to the mean cross-section.
inline LightNode rod_leaf(const RodArray& rods, std::uint32_t id) noexcept {
  const std::size_t index = rods.index(id);
  const bool at_b = (id - rods.first_id) % 2 != 0;
  math::Vec3d ends[4];  // the middle and the end, when the shutter opens and when it closes
  double radius = 0, length = 0;
  for (int time = 0; time < 2; ++time) {
    const Rod rod = rods.at(index, time);
    const math::Vec3d a = math::vector_of(rod.a), b = math::vector_of(rod.b);
    ends[2 * time] = (a + b) / 2;
    ends[2 * time + 1] = at_b ? b : a;
    radius = std::fmax(radius, rod.radius);
    length = std::fmax(length, math::length(b - a) / 2);
  }
  const math::Vec3d center = (ends[0] + ends[1] + ends[2] + ends[3]) / 4;
  double reach = 0;
  for (const math::Vec3d& end : ends) reach = std::fmax(reach, math::length(end - center));
  return {{center.x, center.y, center.z}, reach + radius, radius * (length + radius) / 2};
}

/// The bounding sphere and power of a single emitter, a sphere or half of a rod. The bounding sphere encloses its whole
/// motion.
inline LightNode light_leaf(const SceneView& scene, std::uint32_t id) noexcept {
  const bool is_rod = scene.rods.contains(id);
  const Sphere s = is_rod ? Sphere{} : scene.spheres[id];
  const double* const rgb = scene.emission[scene.object_materials[id]].radiance;
  LightNode leaf{{s.x, s.y, s.z}, s.radius, (rgb[0] + rgb[1] + rgb[2]) * (s.radius * s.radius)};
  if (is_rod) {
    leaf = rod_leaf(scene.rods, id);
    leaf.power *= rgb[0] + rgb[1] + rgb[2];
  }
  if (scene.opacity != nullptr) leaf.power *= static_cast<double>(scene.opacity[id]);
  if (id >= scene.moving_count) return leaf;
  const Sphere& change = scene.motion[id];
  const math::Vec3d half{change.x / 2, change.y / 2, change.z / 2};
  leaf.center[0] += half.x;
  leaf.center[1] += half.y;
  leaf.center[2] += half.z;
  leaf.radius = std::fmax(s.radius, s.radius + change.radius) + math::length(half);
  return leaf;
}

}  // namespace orrery::kernel
