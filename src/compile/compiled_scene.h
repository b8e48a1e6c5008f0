// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compile/caustic_list.h"
#include "compile/forward.h"
#include "compile/light_tree.h"
#include "compile/material_table.h"
#include "compile/pixel_filter.h"
#include "compile/sphere_store.h"
#include "compile/textures.h"
#include "kernel/precision.h"
#include "kernel/scene_view.h"
#include "math/vec3.h"
#include "scene/scene.h"

namespace orrery::compile {

using kernel::Precision;
using scene::Accelerator;

/// A scene ready for rendering: flat arrays, camera basis, and the features that it requires.
///
/// Spheres are in the order of the scene file, first the [[sphere]] tables, then each [[points]] file. The index of a
/// sphere is its id in hits. The ids of rods follow, see kernel::RodArray.
struct CompiledScene : kernel::SceneSettings {
  SphereStore spheres;
  std::vector<std::size_t> points_sizes;  ///< number of spheres of each points table
  /// With ordered ends: [[rod]] tables, then each [[rods]] file, then the stubs of bonds of each points table.
  std::vector<kernel::Rod> rods;
  std::vector<kernel::Bond> bonds;               ///< of each points table; in ids, they follow `rods`
  std::vector<double> bond_radii;                ///< two per points table: of bonds and of traces
  std::vector<std::size_t> rod_file_sizes;       ///< number of rods of each file
  std::vector<std::size_t> stub_counts;          ///< number of stubs of bonds of each points table
  std::vector<std::size_t> bond_counts;          ///< number of bonds of each points table, without those in stubs
  PackedIndices object_materials;                ///< one per sphere, then two per rod, index into `materials`
  std::vector<float> opacity;                    ///< as kernel::SceneView has it; empty: all are 1
  std::vector<MaterialSource> material_sources;  ///< one per material
  std::vector<kernel::Material> materials;
  std::vector<kernel::Emission> emission;  ///< one per material; empty if none emits
  TextureStore textures;
  /// No two spheres coincide in the number type of this precision; empty: not known.
  std::optional<Precision> distinct_in;
  std::optional<Precision> compared_in;   ///< precision of `duplicates`; empty: they are not known
  std::vector<std::uint32_t> duplicates;  ///< see kernel::SceneView
  LightTree light_tree;                   ///< light tree of the emitters; empty if lights are not sampled
  bool samples_caustics = true;           ///< false: `caustics` stays empty
  CausticList caustics;                   ///< of lights that are sampled
  std::vector<std::string> light_groups;  ///< names, indexed by Emission::group; the first is "", the default group
  std::vector<kernel::Sphere>
      motion;  ///< motion of the first motion.size() spheres, see kernel::SceneView; empty: none moves
  std::vector<kernel::Rod> rod_motion;                ///< the same of `rods`
  bool bonds_move = false;                            ///< with their spheres
  std::optional<math::Vec3d> backdrop;                ///< see scene::Background
  std::uint32_t page = kernel::kNone;                 ///< sphere that is a part of the backdrop; kNone: there is none
  std::shared_ptr<const EnvironmentMap> environment;  ///< an image background; null: none
  Precision precision = Precision::kExact;
  Accelerator accelerator = Accelerator::kEmbree;
  std::vector<double> filter;  ///< kernel::PixelFilter::places; empty: a box of one pixel
  int width = 0;               ///< px, of the rendered window
  int height = 0;              ///< px
  int window_x = 0;            ///< px, upper left corner of the window in the frame
  int window_y = 0;            ///< px
  int frame_width = 0;         ///< px
  int frame_height = 0;        ///< px
  double pixel_aspect = 1;     ///< pixel width divided by pixel height
  int samples = 0;             ///< per pixel

  std::size_t rod_count() const noexcept { return rods.size() + bonds.size(); }

  /// Returns a view for the kernel; valid until this CompiledScene is modified or destroyed.
  kernel::SceneView view() const noexcept;
};

/// Returns the bounding box of all spheres and rods; unspecified if there are none.
///
/// Errors     base::Error(kStopped) in a base::StopScope
Bounds bounds_of(const CompiledScene& scene);

}  // namespace orrery::compile
