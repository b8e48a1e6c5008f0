// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "film/display_error.h"
#include "kernel/scene_view.h"
#include "kernel/sphere.h"
#include "math/vec3.h"
#include "render/sphere_images.h"

namespace orrery::render {

/// Emitters that add less radiance to a pixel are ignored: a 32nd of what is negligible in the dark.
inline constexpr double kLeastLight = film::kDarkestLight / 256;

Moving<kernel::Sphere> moving_sphere(const kernel::SceneView& scene, std::size_t id);

/// The mean of the channels.
double mean_of(math::Vec3d rgb);
/// The radiance of a sphere or of half of a rod, mean of the channels.
double radiance_of(const kernel::SceneView& scene, std::size_t id);
/// Of a sphere or of half of a rod.
double opacity_of(const kernel::SceneView& scene, std::size_t id);

/// How a light is seen in a ball.
struct Reflection {
  kernel::Sphere image;  ///< where the light seems to be, as large as it seems
  math::Vec3d point;     ///< that reflects it, from the ball's centre
  double cosine;         ///< of the angle of incidence
};

/// The reflection of a light in a ball. Empty if there is none, or if eye or light are within the ball.
///
/// `steps`     accuracy of the place: 2^-steps radii of the ball
std::optional<Reflection> reflection_of(const kernel::Sphere& light, const kernel::Sphere& ball, math::Vec3d eye,
                                        int steps);

/// `steps` for an accuracy of a small part of a pixel.
///
/// `area`     of the ball's image, square pixels
int reflection_steps(double area);

/// An emitter, or the sun, as a sphere.
struct ReflectedLight {
  Moving<kernel::Sphere> sphere;
  std::uint32_t id;  ///< of a sphere, or kSun
  double radiance;   ///< mean of the channels, times the opacity
};

/// Maximum number of pairs of balls and lights.
inline constexpr std::size_t kMostReflections = std::size_t{1} << 18;

/// Whether a sphere reflects as a mirror does.
bool is_sharp(const kernel::SceneView& scene, std::size_t sphere);

std::size_t count_sharp_balls(const kernel::SceneView& scene);

/// The lights that may be seen in sharp balls: with more than kMostReflections pairs, the sun and the emitters of the
/// greatest power, at least one.
///
/// `balls`    their number
std::vector<ReflectedLight> reflected_lights(const kernel::SceneView& scene, std::size_t balls);

/// An estimate of the radiance that a light in a ball adds to a pixel, at most.
///
/// `area`     of the ball's image, square pixels
double brightest_reflection(const ReflectedLight& light, const kernel::Sphere& ball, double area);

/// What a sharp ball reflects, times its opacity: mean of the channels.
double sharp_reflectance(const kernel::SceneView& scene, std::uint32_t ball, double cosine);

}  // namespace orrery::render
