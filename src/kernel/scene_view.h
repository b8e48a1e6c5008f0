// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "kernel/camera.h"
#include "kernel/material.h"
#include "kernel/pixel_filter.h"
#include "kernel/sampler.h"
#include "kernel/sphere.h"

namespace orrery::kernel {

/// What a ray that leaves the scene sees: bottom + (top - bottom) (y + 1) / 2 of its unit direction.
struct Background {
  double bottom[3] = {1, 1, 1};
  double top[3] = {1, 1, 1};
};

enum class Shading : std::uint8_t { kPath, kNormal, kFlat };

/// What this scene asks of the kernel, as far as leaving it out saves time: what is false here is not computed. A
/// material that no lane of a vector has met is never computed, whatever the scene holds, and needs no bit
/// (docs/decisions/0012-few-feature-bits.md).
struct Features {
  bool lens = false;        ///< the camera has an aperture
  bool hemisphere = false;  ///< some sphere's material is of this kind
  bool sky = false;         ///< the background depends on the direction
  bool motion = false;      ///< camera or spheres move while the shutter is open
};

/// Russian roulette leaves paths alone that still have one part in so many of their light: what they save would not
/// outweigh their noise.
inline constexpr double kRouletteGain = 8;

/// More scattering events than any path has.
inline constexpr std::uint32_t kNoRoulette = 0xffffffffu;

/// The compiled scene as the inner loops see it: pointers into arrays that somebody else owns.
struct SceneView {
  const Sphere* spheres = nullptr;
  const std::uint32_t* sphere_materials = nullptr;  ///< one per sphere, index into `materials`
  const Material* materials = nullptr;
  std::size_t sphere_count = 0;
  /// What becomes of the first spheres until the shutter closes: the change of place and radius. The others rest.
  const Sphere* motion = nullptr;
  std::size_t moving_count = 0;
  Camera camera;
  Camera camera_motion;  ///< the change of its vectors until the shutter closes, where features.motion
  Background background;
  Features features;
  Shading shading = Shading::kPath;
  std::uint32_t max_depth = 50;  ///< rays of a path, the camera ray included; where the last hits there is no light
  /// Scattering events after which Russian roulette ends paths that have little to bring, and strengthens the others.
  std::uint32_t roulette_depth = kNoRoulette;
  Sampler sampler;
  PixelFilter filter;
  /// Where the rendered window begins within the frame, modulo 65536. A pixel's name, which chooses its random numbers,
  /// is its place in the frame, so that a window's pixels are the frame's.
  std::uint32_t window_x = 0, window_y = 0;
  bool background_visible = true;  ///< false: camera rays that leave the scene bring no light
};

/// A sphere at a time between 0, when the shutter opens, and 1, when it closes; as the inner loops compute it.
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

}  // namespace orrery::kernel
