// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "accel/accel.h"
#include "base/stopwatch.h"
#include "compile/compiled_scene.h"
#include "render/forward.h"

namespace orrery::study {

struct Request;

/// The spheres and rods of a scene, lent to one CompiledScene at a time instead of copied, since there may be ten
/// million.
struct Spheres {
  compile::SphereStore spheres;
  compile::PackedIndices materials;
  std::vector<kernel::Rod> rods, rod_motion;
  std::vector<kernel::Bond> bonds;
  std::vector<double> bond_radii;

  /// Exchanges them with those of a compiled scene.
  void swap(compile::CompiledScene& compiled) {
    std::swap(spheres, compiled.spheres);
    std::swap(materials, compiled.object_materials);
    std::swap(rods, compiled.rods);
    std::swap(rod_motion, compiled.rod_motion);
    std::swap(bonds, compiled.bonds);
    std::swap(bond_radii, compiled.bond_radii);
  }
};

/// Renders the images of a study and accumulates their render times.
///
/// All renders share one copy of the spheres, and one accelerator for each precision.
class StudyRenderer {
 public:
  /// Starts the clock.
  ///
  /// Domain     `request` outlives this
  StudyRenderer(const Request& request, int threads) : request_(request), threads_(threads) {}

  /// Takes the spheres out of a scene. All scenes to render are copies of it.
  void take_spheres(compile::CompiledScene& scene) { spheres_.swap(scene); }

  /// Seconds since the study began; with Request::paths_per_s, computed from the number of paths instead.
  double elapsed() const;

  /// Duration of a render, in the same seconds.
  double seconds_of(const render::Statistics& did) const;

  /// Renders with the scene's samples, or with --noise if `noise` is above 0. The image has planes R, G, B. The render
  /// time includes that of denoising.
  ///
  /// Errors     base::Error(kStopped) if the study was cancelled
  render::Result render(compile::CompiledScene& scene, double noise = 0, std::optional<accel::Traversal> traversal = {},
                        bool is_denoised = false);

  /// Measures paths per second, with `pilot` as the scene to render.
  double measure_speed(compile::CompiledScene pilot);

  /// Longest accelerator build so far, s.
  double build_s() const { return build_s_; }
  /// True if the accelerator that a scene needs is built.
  bool has_accelerator(const compile::CompiledScene& scene) const {
    return accels_.count({scene.precision, scene.accelerator}) > 0;
  }
  /// Instruction set of the last render.
  const std::string& isa() const { return isa_; }

 private:
  accel::Accel& accel_of(const compile::CompiledScene& scene);

  const Request& request_;
  int threads_;
  base::Stopwatch since_start_;
  Spheres spheres_;
  std::map<std::pair<compile::Precision, compile::Accelerator>, std::unique_ptr<accel::Accel>> accels_;
  std::string isa_;
  double paths_ = 0;  ///< paths traced so far
  double build_s_ = 0;
};

}  // namespace orrery::study
