// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "plot/view.h"
#include "scene/scene.h"

namespace orrery::plot {

struct PlotOptions;

/// Materials of the rods beside the spheres.
enum GuideMaterial : std::uint32_t { kBoxMaterial, kXMaterial, kYMaterial, kZMaterial };

/// The parts of the scene of a plot.
struct PlotParts {
  const PlotOptions& options;
  int width, height;  ///< px
  const scene::Points& points;
  const scene::Camera& camera;
  const std::string& view;       ///< view of the display
  const ViewAxes& axes;          ///< axes of the image
  Vec3d center;                  ///< centre of the spheres
  double radius = 1;             ///< radius of a sphere around `center` that contains all spheres
  std::optional<int> samples;    ///< per pixel; default: that of scenes
  scene::Annotation annotation;  ///< text and lines over the image
  std::optional<Ground> ground;  ///< ground below the spheres
  /// Edges of the simulation box and axes; their materials are GuideMaterial.
  std::vector<scene::Rod> guides = {};
};

/// Returns the text of the scene file of a plot.
std::string scene_text(const PlotParts& parts);

}  // namespace orrery::plot
