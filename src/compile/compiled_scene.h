// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "compile/filter_tables.h"
#include "kernel/precision.h"
#include "kernel/scene_view.h"
#include "math/vec3.h"
#include "scene/accelerator.h"

namespace orrery::compile {

using kernel::Precision;
using scene::Accelerator;

/// The box around all spheres; meaningless where there is none.
struct Bounds {
  math::Vec3d lower;
  math::Vec3d upper;
};

/// A scene ready to be rendered: flat arrays, camera basis, and what the scene requires.
///
/// Spheres keep the order of the scene file, [[sphere]] tables first, then each [[points]] file; their index is their
/// id in every hit.
struct CompiledScene {
  std::vector<kernel::Sphere> spheres;
  std::vector<std::uint32_t> sphere_materials;  ///< one per sphere, index into `materials`
  std::vector<kernel::Material> materials;
  std::vector<kernel::Sphere> motion;  ///< of the first spheres; see kernel::SceneView. Empty: none moves
  kernel::Camera camera;
  kernel::Camera camera_motion;
  kernel::Background background;
  kernel::Features features;
  kernel::Shading shading = kernel::Shading::kPath;
  Precision precision = Precision::kExact;
  Accelerator accelerator = Accelerator::kEmbree;
  Bounds bounds;
  FilterTables filter;
  int width = 0;                                       ///< px, of what is rendered
  int height = 0;                                      ///< px
  int window_x = 0;                                    ///< px, its upper left corner within the frame
  int window_y = 0;                                    ///< px
  int frame_width = 0;                                 ///< px
  int frame_height = 0;                                ///< px
  double pixel_aspect = 1;                             ///< a pixel's width by its height
  int samples = 0;                                     ///< per pixel
  std::uint32_t max_depth = 0;                         ///< rays of a path, the camera ray included
  std::uint32_t roulette_depth = kernel::kNoRoulette;  ///< scattering events before Russian roulette begins
  kernel::Sampler sampler;

  /// The same for the inner loops; valid as long as this CompiledScene is neither changed nor destroyed.
  kernel::SceneView view() const noexcept;
};

}  // namespace orrery::compile
