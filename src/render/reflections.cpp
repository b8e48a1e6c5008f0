// SPDX-License-Identifier: Apache-2.0
#include "render/reflections.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "kernel/lights.h"
#include "kernel/material.h"

namespace orrery::render {
namespace {

using math::Vec3d;

/// Reference  schlick1994
double schlick(double r0, double cosine) {
  const double x = 1 - cosine, x2 = x * x;
  return r0 + (1 - r0) * x2 * x2 * x;
}

/// Emitters that are reflected: as many as there may be, those of the greatest power.
std::vector<std::uint32_t> strongest_emitters(const kernel::SceneView& scene, std::size_t most) {
  struct Emitter {
    std::uint32_t id;
    double power;
  };
  std::vector<Emitter> emitters;
  for (std::uint32_t id = 0; scene.emission != nullptr && id < scene.sphere_count; ++id) {
    const double radiance = radiance_of(scene, id) * opacity_of(scene, id), radius = scene.spheres[id].radius;
    if (radiance > 0) emitters.push_back({id, radiance * radius * radius});
  }
  if (emitters.size() > most) {
    std::nth_element(
        emitters.begin(), emitters.begin() + static_cast<std::ptrdiff_t>(most), emitters.end(),
        [](const Emitter& a, const Emitter& b) { return a.power != b.power ? a.power > b.power : a.id < b.id; });
    emitters.resize(most);
  }
  std::vector<std::uint32_t> out;
  for (const Emitter& from : emitters) out.push_back(from.id);
  return out;
}

}  // namespace

Moving<kernel::Sphere> moving_sphere(const kernel::SceneView& scene, std::size_t id) {
  return {sphere_at(scene, id, 0), sphere_at(scene, id, 1)};
}

double mean_of(Vec3d rgb) { return (rgb.x + rgb.y + rgb.z) / 3; }

double radiance_of(const kernel::SceneView& scene, std::size_t id) {
  return mean_of(math::vector_of(scene.emission[scene.object_materials[id]].radiance));
}

double opacity_of(const kernel::SceneView& scene, std::size_t id) {
  return scene.opacity != nullptr ? double{scene.opacity[id]} : 1;
}

std::optional<Reflection> reflection_of(const kernel::Sphere& light, const kernel::Sphere& ball, Vec3d eye, int steps) {
  constexpr double kParallel = 1e-3;
  const Vec3d center = center_of(ball), to_eye = (eye - center) / ball.radius,
              to_light = (center_of(light) - center) / ball.radius;
  const double p = length(to_eye), d = length(to_light), radius = light.radius / ball.radius;
  if (!(p > 1 && d > 1 + radius)) return std::nullopt;

  // The point on the arc between both at which both have the same angle to the normal.
  Vec3d nearer = to_eye / p, farther = to_light / d, point;
  const double sine = length(cross(nearer, farther));
  double cosine = 0;
  for (int i = 0; i < steps; ++i) {
    point = normalized(nearer + farther);
    cosine = dot(point, normalized(to_eye - point));
    (cosine > dot(point, normalized(to_light - point)) ? nearer : farther) = point;
  }
  if (!(cosine > 0)) return std::nullopt;  // behind the ball

  // A ray of the impact parameter s = sin i turns around the centre by an angle Theta(i) whose derivative is h(i). The
  // directions in which the light is seen are those of s ds, and those in which the ball sees it of sin Theta dTheta.
  const double s2 = 1 - cosine * cosine, from_eye = std::sqrt(p * p - s2), from_light = std::sqrt(d * d - s2);
  const double h = 2 - cosine / from_eye - cosine / from_light;
  const double ratio = sine > kParallel ? std::sqrt(s2) / sine : 1 / h;
  const double square = radius * radius / (d * from_light) * ratio * cosine / h / (p * from_eye);  // of half its angle
  const Vec3d along = normalized(point - to_eye);
  const double away = length(point - to_eye) + cosine / 2;  // a small mirror's focal length, as it makes images blur
  const Vec3d seen = center + (to_eye + along * away) * ball.radius;
  return Reflection{sphere_around(seen, away * std::sqrt(square) * ball.radius), point * ball.radius, cosine};
}

int reflection_steps(double area) {
  constexpr int kLeast = 8, kMost = 24;  // in a ball of a pixel, whose radius is halved eight times, and at most
  return std::clamp(kLeast + std::ilogb(area) / 2, kLeast, kMost);
}

bool is_sharp(const kernel::SceneView& scene, std::size_t sphere) {
  const std::uint32_t index = scene.object_materials[sphere];
  const kernel::Material& material = scene.materials[index];
  const bool reflects = kernel::traits_of(material.kind).is_specular || material.kind == kernel::MaterialKind::kPlastic;
  return reflects && material.fuzz == 0 &&
         (scene.material_textures == nullptr || scene.material_textures[index].fuzz == kernel::kNone);
}

std::size_t count_sharp_balls(const kernel::SceneView& scene) {
  std::size_t balls = 0;
  for (std::size_t id = 0; id < scene.sphere_count; ++id) balls += is_sharp(scene, id) ? 1 : 0;
  return balls;
}

std::vector<ReflectedLight> reflected_lights(const kernel::SceneView& scene, std::size_t balls) {
  std::vector<ReflectedLight> out;
  if (balls == 0) return out;
  for (const std::uint32_t id : strongest_emitters(scene, std::max<std::size_t>(kMostReflections / balls, 1)))
    out.push_back({moving_sphere(scene, id), id, radiance_of(scene, id) * opacity_of(scene, id)});
  const kernel::Environment* const sky = scene.environment;
  if (sky == nullptr || !sky->has_sun) return out;
  const kernel::Sphere sun = distant_sphere(scene.camera, sky->sun, 2 * std::numbers::pi * sky->sun_one_minus_cos);
  out.push_back({{sun, sun}, kernel::kSun, mean_of(sky->sun_radiance)});
  return out;
}

double brightest_reflection(const ReflectedLight& light, const kernel::Sphere& ball, double area) {
  // Seen from afar, the reflection is as large as the light from the ball, on a sphere of half the ball's radius.
  const kernel::Sphere& from = light.sphere[0];
  const double sine = from.radius / (length(center_of(from) - center_of(ball)) - ball.radius);
  return light.radiance * area / 4 * sine * sine;
}

double sharp_reflectance(const kernel::SceneView& scene, std::uint32_t ball, double cosine) {
  const kernel::Material& material = scene.materials[scene.object_materials[ball]];
  const bool is_metal = material.kind == kernel::MaterialKind::kMetal;
  const double albedo = is_metal ? mean_of(math::vector_of(material.albedo)) : schlick(material.r0[0], cosine);
  return albedo * opacity_of(scene, ball);
}

}  // namespace orrery::render
