// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "baseline/material.h"
#include "scene/scene.h"

namespace orrery::bench::baseline {

/// What rays are tested against: the book's list, or Embree's own sphere points.
enum class Spheres { kList, kNativePoints };

/// A scene and its camera as the book's program holds them.
class Program {
 public:
  /// Takes spheres, camera, background and settings over from an authored scene.
  ///
  /// Domain     a scene that scene::validate finds no error in
  /// Errors     base::Error(kUsage) for what the book's last program does not have
  explicit Program(const scene::Scene& scene, Spheres spheres = Spheres::kList);

  /// Renders on the calling thread.
  ///
  /// Shape      one colour per pixel, rows from the top, left to right
  /// Units      scene-linear, mean of the samples
  std::vector<Vec3d> render(std::uint64_t seed);

  /// Rays that render() has traced so far.
  std::uint64_t rays() const { return rays_; }

  const Hittable& world() const { return *world_; }

 private:
  Ray camera_ray(int x, int y, Random& random) const;
  Vec3d ray_color(const Ray& ray, int depth, Random& random);

  std::vector<std::unique_ptr<const Material>> materials_;
  std::unique_ptr<const Hittable> world_;
  scene::Background background_;
  int width_, height_, samples_, max_depth_;
  Vec3d origin_, first_pixel_, right_, down_, lens_u_, lens_v_;
  bool has_lens_;
  std::uint64_t rays_ = 0;
};

}  // namespace orrery::bench::baseline
