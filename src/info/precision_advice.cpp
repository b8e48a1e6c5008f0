// SPDX-License-Identifier: Apache-2.0
#include "info/info.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/core.h>

#include "compile/compiled_scene.h"
#include "kernel/material.h"
#include "kernel/precision.h"
#include "kernel/sphere.h"
#include "math/vec3.h"

namespace orrery::info {
namespace {

/// Hit point error, relative to the sphere's radius, that is visible in a close-up.
constexpr double kVisible = 1e-3;

struct Proportions {
  double smallest = std::numeric_limits<double>::infinity();  ///< minimum radius, scene units
  double farthest = 0;    ///< maximum distance from the camera to a sphere's centre, in radii of that sphere
  double coordinate = 0;  ///< maximum absolute coordinate of a centre or the camera, in radii of the smallest sphere
};

Proportions proportions_of(const compile::CompiledScene& compiled) {
  Proportions p;
  double largest = 0;
  const math::Vec3d& o = compiled.camera.origin;
  for (const double x : {o.x, o.y, o.z}) largest = std::max(largest, std::abs(x));
  for (std::size_t i = 0; i < compiled.spheres.size(); ++i) {
    const kernel::Sphere s = compiled.spheres[i];
    p.smallest = std::min(p.smallest, s.radius);
    for (const double x : {s.x, s.y, s.z}) largest = std::max(largest, std::abs(x));
    p.farthest = std::max(p.farthest, length(math::Vec3d{s.x, s.y, s.z} - o) / s.radius);
  }
  p.coordinate = largest / p.smallest;
  return p;
}

/// The smallest emitter that the surface of the largest sphere passes through: a lamp half sunk into a ground. Negative
/// radius: there is none.
double sunk_lamp_radius(const compile::CompiledScene& compiled, const kernel::Sphere& ground) {
  double smallest = -1;
  for (std::size_t i = 0; i < compiled.spheres.size(); ++i) {
    if (compiled.materials[compiled.object_materials[i]].kind != kernel::MaterialKind::kEmitter) continue;
    const kernel::Sphere s = compiled.spheres[i];
    const double dx = s.x - ground.x, dy = s.y - ground.y, dz = s.z - ground.z;
    const double height = std::sqrt(dx * dx + dy * dy + dz * dz) - ground.radius;
    if (s.radius < ground.radius && std::abs(height) < s.radius && (smallest < 0 || s.radius < smallest))
      smallest = s.radius;
  }
  return smallest;
}

kernel::Sphere largest_sphere(const compile::CompiledScene& compiled) {
  kernel::Sphere largest = compiled.spheres[0];
  for (std::size_t i = 1; i < compiled.spheres.size(); ++i)
    if (compiled.spheres[i].radius > largest.radius) largest = compiled.spheres[i];
  return largest;
}

}  // namespace

std::vector<std::string> precision_advice(const compile::CompiledScene& compiled) {
  if (compiled.precision == compile::Precision::kExact || compiled.spheres.empty()) return {};
  const Proportions p = proportions_of(compiled);
  std::vector<std::string> advice;
  if (compiled.precision == compile::Precision::kFast) {
    // Ray origins and centres are rounded to float before the subtraction.
    const double error = 0x1p-23 * p.coordinate;
    if (error > kVisible)
      advice.push_back(fmt::format(
          "precision fast: hit points on the smallest sphere (radius {:g}) have an error of about {:.1g} of its "
          "radius, since coordinates reach {:.1g} radii; use exact",
          p.smallest, error, p.coordinate));
    // Points on the ground are off by up to 2^-23 of its radius, and so is the part of the lamp above their horizon.
    const kernel::Sphere ground = largest_sphere(compiled);
    const double lamp = sunk_lamp_radius(compiled, ground), light = 0x1p-22 * ground.radius / lamp;
    if (light > kVisible)
      advice.push_back(
          fmt::format("precision fast: light of a lamp of radius {:g}, partly inside a sphere of radius {:g}, has an "
                      "error of about {:.1g} beside it; use exact",
                      lamp, ground.radius, light));
    return advice;
  }
  // The quadratic subtracts the squared radius from the squared distance: cancellation grows with their ratio.
  const double error = 0x1p-52 * p.farthest * p.farthest;
  if (error > kVisible)
    advice.push_back(fmt::format(
        "precision book: a sphere is {:.1g} radii from the camera; the error of the quadratic's discriminant is "
        "about {:.1g} of its maximum there, so hits are missed, or spurious hits appear; use exact",
        p.farthest, error));
  if (p.smallest < 20 * kernel::kBookShortestDistance)
    advice.push_back(
        fmt::format("precision book: radius {:g} is close to t_min {:g}, so light leaks where spheres touch; use exact",
                    p.smallest, kernel::kBookShortestDistance));
  return advice;
}

}  // namespace orrery::info
