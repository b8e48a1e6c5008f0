// SPDX-License-Identifier: Apache-2.0
#include "compile/caustic_list.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "kernel/scene_view.h"
#include "math/vec3.h"

namespace orrery::compile {
namespace {

using kernel::CausticBall;
using kernel::CausticLight;
using kernel::Caustics;
using kernel::kNone;
using kernel::Material;
using kernel::MaterialTextures;
using kernel::SceneView;
using math::Vec3d;

bool is_textured(const SceneView& scene, std::size_t material) {
  if (scene.material_textures == nullptr) return false;
  const MaterialTextures& textures = scene.material_textures[material];
  return textures.albedo != kNone || textures.fuzz != kNone || textures.radiance != kNone;
}

bool is_clear(const Material& material) { return kernel::traits_of(material.kind).transmits; }

/// Whether balls of a material are perfect mirrors or clear glass.
bool is_sharp(const SceneView& scene, std::size_t index) {
  const Material& material = scene.materials[index];
  if (!kernel::traits_of(material.kind).is_specular) return false;
  return material.fuzz == 0 && (scene.material_textures == nullptr || scene.material_textures[index].fuzz == kNone);
}

/// Whether the images in balls of a sharp material are sampled.
bool is_sampled(const SceneView& scene, std::size_t index) {
  const Material& material = scene.materials[index];
  if (is_textured(scene, index)) return false;
  if (is_clear(material)) return material.eta[1] > 1;
  return material.albedo[0] + material.albedo[1] + material.albedo[2] > 0;
}

/// Whether spheres of a sharp material may be the void of a hollow ball.
bool is_void(const SceneView& scene, std::size_t index) {
  const Material& material = scene.materials[index];
  return is_clear(material) && material.eta[1] < 1 && !is_textured(scene, index);
}

bool is_visible(const SceneView& scene, std::size_t sphere) {
  return scene.opacity == nullptr || scene.opacity[sphere] > 0;
}

/// Balls of sharp materials.
struct SharpBalls {
  std::vector<std::uint32_t> sampled;  ///< sphere ids, ascending
  std::vector<std::uint32_t> voids;    ///< clear glass of an index below 1, which may make others hollow
  std::uint64_t count = 0;             ///< with those that are not sampled
};

SharpBalls sharp_balls(const SceneView& scene) {
  enum : std::uint8_t { kOther, kSharp, kSampled, kVoid };
  SharpBalls out;
  if (scene.sphere_count == 0) return out;
  std::uint32_t last = 0;
  for (std::size_t i = 0; i < scene.sphere_count; ++i) last = std::max(last, scene.object_materials[i]);
  std::vector<std::uint8_t> uses;
  for (std::size_t m = 0; m <= last; ++m)
    uses.push_back(!is_sharp(scene, m) ? kOther : is_sampled(scene, m) ? kSampled : is_void(scene, m) ? kVoid : kSharp);
  if (std::all_of(uses.begin(), uses.end(), [](std::uint8_t use) { return use == kOther; })) return out;
  for (std::uint32_t i = 0; i < scene.sphere_count; ++i) {
    const std::uint8_t use = uses[scene.object_materials[i]];
    if (use == kOther || !is_visible(scene, i)) continue;
    ++out.count;
    if (use == kSampled) out.sampled.push_back(i);
    if (use == kVoid) out.voids.push_back(i);
  }
  return out;
}

/// An emitter, with its power as in the light tree.
struct Emitter {
  std::uint32_t sphere;
  double power;
};

/// The emitters of greatest power, by ascending id.
std::vector<Emitter> emitters_of(const SceneView& scene) {
  std::vector<Emitter> out;
  for (std::uint32_t leaf = 0; leaf < scene.lights.count; ++leaf) {
    const std::uint32_t id = scene.lights.spheres[leaf];
    if (!is_textured(scene, scene.object_materials[id])) out.push_back({id, kernel::light_leaf(scene, id).power});
  }
  const auto by_id = [](const Emitter& a, const Emitter& b) { return a.sphere < b.sphere; };
  if (out.size() > kMaxCausticLights) {
    std::nth_element(out.begin(), out.begin() + kMaxCausticLights, out.end(), [&](const Emitter& a, const Emitter& b) {
      return a.power != b.power ? a.power > b.power : by_id(a, b);
    });
    out.resize(kMaxCausticLights);
  }
  std::sort(out.begin(), out.end(), by_id);
  return out;
}

/// A sphere when the shutter opens, and its change until it closes.
struct Moving {
  Vec3d center, displacement;
  double radius, growth;
};

Moving moving(const SceneView& scene, std::uint32_t id) {
  const kernel::Sphere s = scene.spheres[id];
  Moving out{{s.x, s.y, s.z}, {0, 0, 0}, s.radius, 0};
  if (id < scene.moving_count) {
    const kernel::Sphere& change = scene.motion[id];
    out.displacement = {change.x, change.y, change.z};
    out.growth = change.radius;
  }
  return out;
}

/// Distances between the centres of a ball and a light.
struct Separation {
  double least, greatest;
};

Separation separation(const Moving& ball, const Moving& light) {
  const Vec3d from = light.center - ball.center, change = light.displacement - ball.displacement;
  const double square = dot(change, change);
  const double nearest = square > 0 ? std::clamp(-dot(from, change) / square, 0.0, 1.0) : 0;
  return {length(from + change * nearest), std::max(length(from), length(from + change))};
}

double sum_of(const double (&rgb)[3]) { return rgb[0] + rgb[1] + rgb[2]; }

/// The part of light that a ball of this material scatters.
double scattered_part(const SceneView& scene, std::uint32_t ball) {
  const Material& material = scene.materials[scene.object_materials[ball]];
  return is_clear(material) ? 1 : sum_of(material.albedo) / 3;
}

/// The irradiance at a ball's centre from each of its lights, times a constant; 0: the pair is not listed.
struct Irradiances {
  const SceneView& scene;
  double smallest_light;  ///< sine of its half angle

  double from_emitter(const Moving& ball, const Emitter& emitter) const {
    const Moving light = moving(scene, emitter.sphere);
    const Separation distance = separation(ball, light);
    const double reach = ball.radius + std::max(ball.growth, 0.0) + light.radius + std::max(light.growth, 0.0);
    const double smallest = std::min(light.radius, light.radius + light.growth);
    if (!(distance.least >= reach) || smallest / distance.greatest < smallest_light) return 0;
    return emitter.power / (distance.least * distance.least);
  }

  double from_sun() const {
    const kernel::Environment& sky = *scene.environment;
    const double sine2 = sky.sun_one_minus_cos * (2 - sky.sun_one_minus_cos);
    if (sine2 < smallest_light * smallest_light) return 0;
    return (sky.sun_radiance.x + sky.sun_radiance.y + sky.sun_radiance.z) * sine2;
  }
};

/// Appends the lights of a ball to `lights`, with the sum of their irradiances before each as `cumulative`.
///
/// Result     their sum
double append_lights(const Irradiances& irradiance, const Moving& ball, const std::vector<Emitter>& emitters,
                     bool has_sun, std::vector<CausticLight>& lights) {
  double sum = 0;
  const auto add = [&](std::uint32_t light, double value) {
    if (!(value > 0)) return;
    sum += value;
    lights.push_back({light, sum, value});
  };
  for (const Emitter& emitter : emitters) add(emitter.sphere, irradiance.from_emitter(ball, emitter));
  if (has_sun) add(kernel::kSun, irradiance.from_sun());
  return sum;
}

/// A ball without its lights.
CausticBall ball_of(const SceneView& scene, std::uint32_t id, const Moving& moves, double irradiance) {
  CausticBall ball;
  ball.sphere = id;
  const Vec3d half = moves.displacement / 2;
  math::set(ball.center, moves.center + half);
  ball.radius = std::max(moves.radius, moves.radius + moves.growth) + length(half);
  ball.power = irradiance * scattered_part(scene, id) * ball.radius * ball.radius;
  return ball;
}

/// The largest void that is concentric with a ball of glass and smaller at all times, and whose index is the reciprocal
/// of the ball's; kNone: there is none.
std::uint32_t void_of(const SceneView& scene, std::uint32_t ball, const std::vector<std::uint32_t>& voids) {
  constexpr double kSameIndex = 1e-9;  // indices are authored with fewer digits
  const auto eta = [&](std::uint32_t id) { return scene.materials[scene.object_materials[id]].eta[1]; };
  if (!is_clear(scene.materials[scene.object_materials[ball]])) return kNone;
  const Moving outer = moving(scene, ball);
  std::uint32_t found = kNone;
  double largest = 0;
  for (const std::uint32_t id : voids) {
    const Moving inner = moving(scene, id);
    if (inner.center != outer.center || inner.displacement != outer.displacement) continue;
    if (!(inner.radius < outer.radius && inner.radius + inner.growth < outer.radius + outer.growth)) continue;
    if (std::abs(eta(ball) * eta(id) - 1) > kSameIndex || !(inner.radius > largest)) continue;
    found = id;
    largest = inner.radius;
  }
  return found;
}

/// Keeps the kMaxBalls of greatest power, and none if they have less than half of the power.
void keep_strongest(CausticList& list) {
  if (list.balls.size() <= Caustics::kMaxBalls) return;
  double all = 0, kept = 0;
  for (const CausticBall& ball : list.balls) all += ball.power;
  std::nth_element(list.balls.begin(), list.balls.begin() + Caustics::kMaxBalls, list.balls.end(),
                   [](const CausticBall& a, const CausticBall& b) {
                     return a.power != b.power ? a.power > b.power : a.sphere < b.sphere;
                   });
  list.balls.resize(Caustics::kMaxBalls);
  std::sort(list.balls.begin(), list.balls.end(),
            [](const CausticBall& a, const CausticBall& b) { return a.sphere < b.sphere; });
  for (const CausticBall& ball : list.balls) kept += ball.power;
  if (kept < all / 2) list.balls.clear();
}

bool has_sampled_sun(const SceneView& scene) {
  return scene.environment != nullptr && scene.environment->is_sampled && scene.environment->has_sun &&
         scene.environment->sun_probability > 0;
}

}  // namespace

kernel::Caustics CausticList::view() const noexcept {
  kernel::Caustics out;
  if (balls.empty()) return out;
  out.balls = balls.data();
  out.count = static_cast<std::uint32_t>(balls.size());
  out.lights = lights.data();
  out.has_hollow = std::any_of(balls.begin(), balls.end(), [](const CausticBall& ball) { return ball.inner != kNone; });
  out.inverse_reference = kernel::kCausticReach * kernel::kCausticReach / strongest;
  return out;
}

CausticList caustic_list(const SceneView& scene, kernel::Precision precision) {
  CausticList out;
  const bool has_sun = has_sampled_sun(scene);
  const std::uint64_t lights = std::uint64_t{scene.lights.count} + (has_sun ? 1 : 0);
  if (precision == kernel::Precision::kBook || lights == 0) return out;
  const SharpBalls balls = sharp_balls(scene);
  out.pairs = balls.count * lights;
  if (balls.sampled.empty()) return out;
  const std::vector<Emitter> emitters = emitters_of(scene);
  const Irradiances irradiance{scene, precision == kernel::Precision::kFast ? kSmallestLightInFast : 0};
  for (const std::uint32_t id : balls.sampled) {
    const Moving moves = moving(scene, id);
    const double sum = append_lights(irradiance, moves, emitters, has_sun, out.lights);
    out.lights.clear();  // those of the balls that are kept are added later, since all would take too much memory
    if (sum > 0) out.balls.push_back(ball_of(scene, id, moves, sum));
  }
  keep_strongest(out);
  for (CausticBall& ball : out.balls) {
    ball.begin = static_cast<std::uint32_t>(out.lights.size());
    const double sum = append_lights(irradiance, moving(scene, ball.sphere), emitters, has_sun, out.lights);
    ball.end = static_cast<std::uint32_t>(out.lights.size());
    for (std::uint32_t i = ball.begin; i < ball.end; ++i) {
      out.lights[i].cumulative /= sum;
      out.lights[i].probability /= sum;
    }
    ball.inner = void_of(scene, ball.sphere, balls.voids);
    out.strongest = std::max(out.strongest, ball.power / (ball.radius * ball.radius));
  }
  return out;
}

}  // namespace orrery::compile
