// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "data/table.h"
#include "math/scalar.h"
#include "plot/view.h"
#include "scene/scene.h"

namespace orrery::plot {

struct PlotOptions;

/// Where the spheres of a plot are, and how they are seen.
struct Stage {
  const ViewAxes& axes;          ///< axes of the image
  Vec3d up;                      ///< the up axis
  const std::string& material;   ///< of the spheres, one of material_names()
  Vec3d center;                  ///< centre of the spheres
  double radius = 1;             ///< radius of a sphere around `center` that contains all spheres
  double reach = 0;              ///< largest absolute coordinate of a point of the spheres
  std::optional<Ground> ground;  ///< ground below the spheres
  double gain = 1;               ///< of the light
};

/// Materials of the spheres. Colours replace the albedo.
const std::vector<scene::Material>& sphere_materials();

/// Returns the text of the scene file of a plot.
///
/// `scene`    camera, points with their material and annotation; its rods are those of Guides, without materials
/// Errors     base::Error(kBadData) if a scene has no room for the lamp, the ground or the camera around the spheres
std::string scene_text(const PlotOptions& options, const Stage& stage, scene::Scene scene);

/// Rods beside the spheres: the edges of the simulation box, and the axes in the lower corner of what is shown.
class Guides {
 public:
  explicit Guides(const Vec3d& up) : up_(up) {}

  /// Includes spheres in what is shown.
  void surround(const scene::Points& points);
  /// Adds the edges of a periodic box, repeated along each edge, and includes it in `extent`.
  void add_box(const data::Box& box, const Vec3d& counts, ViewExtent& extent);
  /// Adds a tripod: the axes x, y and z outside the lower corner of what is shown, or a, b and c of a unit cell, which
  /// may be far from such a corner, beside it in the image.
  void add_axes(const ViewExtent& extent, const std::optional<data::Box>& cell);

  /// The rods, named after their materials: "box", "axis_x", "axis_y", "axis_z", "axis_a" and so on. They have no
  /// materials yet.
  const std::vector<scene::Rod>& rods() const { return rods_; }
  /// The ends of the rods, as spheres.
  const scene::Points& ends() const { return ends_; }
  /// Lowest point of the spheres and the rods along the up axis, scene units.
  double lowest() const { return lowest_; }
  /// Largest absolute coordinate of a point of what is shown, scene units.
  double reach() const { return reach_; }

 private:
  void surround(const Vec3d& center, double radius);
  void add(const Vec3d& from, const Vec3d& to, double radius, const char* name);

  Vec3d up_;
  Vec3d corner_{math::kInfinity, math::kInfinity, math::kInfinity};  ///< lower corner of what is shown along x, y and z
  double lowest_ = math::kInfinity, reach_ = 0;
  std::vector<scene::Rod> rods_;
  scene::Points ends_;
};

}  // namespace orrery::plot
