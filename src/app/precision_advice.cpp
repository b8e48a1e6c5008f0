// SPDX-License-Identifier: Apache-2.0
#include "app/precision_advice.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "kernel/precision.h"

namespace orrery::app {
namespace {

/// A hit point that is off by this share of its sphere's radius can be seen in a close-up.
constexpr double kVisible = 1e-3;

struct Proportions {
  double smallest = std::numeric_limits<double>::infinity();  ///< radius, scene units
  double farthest = 0;    ///< camera to a sphere's centre, in radii of that sphere: the worst of all
  double coordinate = 0;  ///< largest absolute coordinate of a centre or the camera, in radii of the smallest sphere
};

Proportions proportions_of(const compile::CompiledScene& compiled) {
  Proportions p;
  double largest = 0;
  const double* o = compiled.camera.origin;
  for (const double x : {o[0], o[1], o[2]}) largest = std::max(largest, std::abs(x));
  for (const kernel::Sphere& s : compiled.spheres) {
    p.smallest = std::min(p.smallest, s.radius);
    for (const double x : {s.x, s.y, s.z}) largest = std::max(largest, std::abs(x));
    const double dx = s.x - o[0], dy = s.y - o[1], dz = s.z - o[2];
    p.farthest = std::max(p.farthest, std::sqrt(dx * dx + dy * dy + dz * dz) / s.radius);
  }
  p.coordinate = largest / p.smallest;
  return p;
}

template <class... Arguments>
std::string text(const char* format, Arguments... arguments) {
  char line[300];
  std::snprintf(line, sizeof(line), format, arguments...);
  return line;
}

}  // namespace

std::vector<std::string> precision_advice(const compile::CompiledScene& compiled) {
  if (compiled.precision == compile::Precision::kExact || compiled.spheres.empty()) return {};
  const Proportions p = proportions_of(compiled);
  std::vector<std::string> advice;
  if (compiled.precision == compile::Precision::kFast) {
    // Origins and centres are rounded to floats before they are subtracted.
    const double error = 0x1p-23 * p.coordinate;
    if (error > kVisible)
      advice.push_back(
          text("precision fast: hits on the smallest sphere (radius %g) are off by about %.1g of its radius, since "
               "coordinates reach %.1g radii; exact is not",
               p.smallest, error, p.coordinate));
    return advice;
  }
  // The quadratic squares the distance and takes the radius from it: the ratio's square eats the digits.
  const double error = 0x1p-52 * p.farthest * p.farthest;
  if (error > kVisible)
    advice.push_back(
        text("precision book: a sphere is %.1g radii from the camera; the quadratic's discriminant is off by about "
             "%.1g of its largest value there, so hits are lost and invented; exact does neither",
             p.farthest, error));
  if (p.smallest < 20 * kernel::kBookShortestDistance)
    advice.push_back(
        text("precision book: radius %g is near t_min, %g: light leaks where spheres touch; exact has no t_min",
             p.smallest, kernel::kBookShortestDistance));
  return advice;
}

}  // namespace orrery::app
