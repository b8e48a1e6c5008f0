// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "kernel/camera.h"
#include "kernel/forward.h"
#include "kernel/seen_emitters.h"
#include "kernel/sphere.h"
#include "math/vec3.h"

namespace orrery::kernel {

/// A disc on the film around the image of a sphere with the blur of the lens, px from the centre of the frame.
struct FilmDisc {
  double x, y, radius;
};

/// Domain     a perspective camera in front of the sphere
FilmDisc film_disc(const Camera& camera, const Sphere& sphere) noexcept;

/// Random numbers of a path.
struct SeenEmitterNumbers {
  double film[2], lens[2];   ///< of its camera ray: before the pixel filter, and on the unit disc
  double other[2], disc[2];  ///< uniform in the unit square, and on the unit disc
};

/// An emitter of a pixel that was chosen for a path.
struct SeenEmitterChoice {
  SeenEmitter emitter;
  double probability;
};

/// Domain     `emitters` is not empty
SeenEmitterChoice choose_seen_emitter(std::span<const SeenEmitter> emitters, double choice) noexcept;

/// A camera ray to an emitter.
struct SeenEmitterSample {
  math::Vec3d offset;  ///< from the camera's origin to the lens
  math::Vec3d reach;   ///< from there to the emitter
  double weight = 0;   ///< of the emitter's radiance in the pixel; 0: there is no ray
};

/// Samples a point of the lens from which a point of the film sees an emitter, or a point of the film in which a point
/// of the lens sees it. Both are in an ellipse, the section of a cone with a plane.
///
/// `pixel`    its centre, px from the centre of the frame
/// Domain     the emitter is seen directly; camera and emitter do not move
/// Reference  docs/decisions/0046
SeenEmitterSample sample_seen_emitter(const SceneView& scene, const SeenEmitter& emitter, const double (&pixel)[2],
                                      const SeenEmitterNumbers& numbers) noexcept;

/// The density of a pixel's camera rays from a point of the lens, per steradian.
///
/// `pixel`      as above
/// `direction`  unit
/// Domain       a perspective camera that does not move
double camera_ray_density(const SceneView& scene, const double (&pixel)[2], math::Vec3d offset,
                          math::Vec3d direction) noexcept;

}  // namespace orrery::kernel
