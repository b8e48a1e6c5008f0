// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "baseline/material.h"
#include "scene/scene.h"

namespace orrery::bench::baseline {

/// The accelerator: the book's list, or Embree's sphere points.
enum class Spheres { kList, kNativePoints };

/// A scene and camera in the representation of the book's program.
class Program {
 public:
  /// Converts spheres, camera, background and settings from an authored scene.
  ///
  /// Domain     a scene in which scene::validate finds no error
  /// Errors     base::Error(kUsage) for features that the book's final program does not have
  explicit Program(const scene::Scene& scene, Spheres spheres = Spheres::kList);

  /// Renders on the calling thread.
  ///
  /// Shape      one colour per pixel, row by row from the top, left to right
  /// Units      scene-linear; mean of the samples
  std::vector<Vec3d> render(std::uint64_t seed);

  /// Number of rays traced by render() so far.
  std::uint64_t rays() const { return rays_; }

  const Hittable& compiled() const { return *world_; }

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
