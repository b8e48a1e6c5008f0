// SPDX-License-Identifier: Apache-2.0
#include "compile/caustic_list.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "base/stop_point.h"
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

/// What spheres of a material are to the list.
enum class Use : std::uint8_t { kOther, kSharp, kSampled, kVoid };

/// The uses of the materials of all spheres; empty: none is sharp.
std::vector<Use> uses_of(const SceneView& scene) {
  std::uint32_t last = 0;
  for (std::size_t i = 0; i < scene.sphere_count; ++i) last = std::max(last, scene.object_materials[i]);
  std::vector<Use> uses;
  for (std::size_t m = 0; m <= last && scene.sphere_count > 0; ++m)
    uses.push_back(!is_sharp(scene, m)    ? Use::kOther
                   : is_sampled(scene, m) ? Use::kSampled
                   : is_void(scene, m)    ? Use::kVoid
                                          : Use::kSharp);
  if (std::all_of(uses.begin(), uses.end(), [](Use use) { return use == Use::kOther; })) uses.clear();
  return uses;
}

/// Calls `visit(id, use)` for each visible sphere of a sharp material, by ascending id.
///
/// Errors     base::Error(kStopped) in a base::StopScope
template <class Visit>
void each_sharp(const SceneView& scene, const std::vector<Use>& uses, Visit visit) {
  const base::StopPoint stop;
  for (std::uint32_t id = 0; id < scene.sphere_count; ++id) {
    stop.check(id);
    const Use use = uses[scene.object_materials[id]];
    if (use == Use::kOther || !is_visible(scene, id)) continue;
    stop.check();  // each may be visited with many lights
    visit(id, use);
  }
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

/// An emitter, with its power as in the light tree.
struct Emitter {
  std::uint32_t sphere;
  double power;
  Moving moves;
};

/// The emitters of greatest power, by ascending id.
std::vector<Emitter> emitters_of(const SceneView& scene) {
  std::vector<Emitter> out;
  for (std::uint32_t leaf = 0; leaf < scene.lights.count; ++leaf) {
    const std::uint32_t id = scene.lights.spheres[leaf];
    if (!scene.rods.contains(id) && !is_textured(scene, scene.object_materials[id]))
      out.push_back({id, kernel::light_leaf(scene, id).power, {}});
  }
  const auto by_id = [](const Emitter& a, const Emitter& b) { return a.sphere < b.sphere; };
  if (out.size() > kMaxCausticLights) {
    std::nth_element(out.begin(), out.begin() + kMaxCausticLights, out.end(), [&](const Emitter& a, const Emitter& b) {
      return a.power != b.power ? a.power > b.power : by_id(a, b);
    });
    out.resize(kMaxCausticLights);
  }
  std::sort(out.begin(), out.end(), by_id);
  for (Emitter& emitter : out) emitter.moves = moving(scene, emitter.sphere);
  return out;
}

/// Distances between the centres of a ball and a light.
struct Separation {
  double least, greatest;
};

Separation separation(const Moving& ball, const Moving& light) {
  const Vec3d from = light.center - ball.center, change = light.displacement - ball.displacement;
  const double square = dot(change, change);
  if (square == 0) return {length(from), length(from)};
  const double nearest = std::clamp(-dot(from, change) / square, 0.0, 1.0);
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
    const Moving& light = emitter.moves;
    const Separation distance = separation(ball, light);
    const double reach = ball.radius + std::max(ball.growth, 0.0) + light.radius + std::max(light.growth, 0.0);
    const double smallest = std::min(light.radius, light.radius + light.growth);
    if (!(distance.least >= reach)) return 0;
    if (smallest_light > 0 && smallest / distance.greatest < smallest_light) return 0;
    return emitter.power / (distance.least * distance.least);
  }

  double from_sun() const {
    const kernel::Environment& sky = *scene.environment;
    const double sine2 = sky.sun_one_minus_cos * (2 - sky.sun_one_minus_cos);
    if (sine2 < smallest_light * smallest_light) return 0;
    return (sky.sun_radiance.x + sky.sun_radiance.y + sky.sun_radiance.z) * sine2;
  }
};

/// Calls `add(light, irradiance)` for each light of a ball.
template <class Add>
void each_light(const Irradiances& irradiance, const Moving& ball, const std::vector<Emitter>& emitters, bool has_sun,
                Add add) {
  for (const Emitter& emitter : emitters)
    if (const double value = irradiance.from_emitter(ball, emitter); value > 0) add(emitter.sphere, value);
  if (!has_sun) return;
  if (const double value = irradiance.from_sun(); value > 0) add(kernel::kSun, value);
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

/// Whether a void is within a ball of clear glass at all times, concentric, and of the reciprocal index.
bool is_void_of(const SceneView& scene, std::uint32_t id, const Moving& inner, std::uint32_t ball,
                const Moving& outer) {
  constexpr double kSameIndex = 1e-9;  // indices are authored with fewer digits
  if (inner.center != outer.center || inner.displacement != outer.displacement) return false;
  if (!(inner.radius < outer.radius && inner.radius + inner.growth < outer.radius + outer.growth)) return false;
  const Material &around = scene.materials[scene.object_materials[ball]],
                 &within = scene.materials[scene.object_materials[id]];
  return is_clear(around) && std::abs(around.eta[1] * within.eta[1] - 1) <= kSameIndex;
}

/// Sets the largest void of each ball.
void add_voids(const SceneView& scene, const std::vector<Use>& uses, std::vector<CausticBall>& balls) {
  std::vector<Moving> outer;
  for (const CausticBall& ball : balls) outer.push_back(moving(scene, ball.sphere));
  std::vector<double> largest(balls.size(), 0.0);
  each_sharp(scene, uses, [&](std::uint32_t id, Use use) {
    if (use != Use::kVoid) return;
    const Moving inner = moving(scene, id);
    for (std::size_t i = 0; i < balls.size(); ++i) {
      if (!(inner.radius > largest[i]) || !is_void_of(scene, id, inner, balls[i].sphere, outer[i])) continue;
      balls[i].inner = id;
      largest[i] = inner.radius;
    }
  });
}

/// The kMaxBalls of greatest power.
class StrongestBalls {
 public:
  void add(const CausticBall& ball) {
    power_ += ball.power;
    ++count_;
    balls_.push_back(ball);
    std::push_heap(balls_.begin(), balls_.end(), is_stronger);
    if (balls_.size() <= Caustics::kMaxBalls) return;
    std::pop_heap(balls_.begin(), balls_.end(), is_stronger);
    balls_.pop_back();
  }

  /// Result     by ascending id; empty if there were more, of which these have less than half of the power
  std::vector<CausticBall> take() {
    std::sort(balls_.begin(), balls_.end(),
              [](const CausticBall& a, const CausticBall& b) { return a.sphere < b.sphere; });
    double kept = 0;
    for (const CausticBall& ball : balls_) kept += ball.power;
    if (count_ > balls_.size() && kept < power_ / 2) balls_.clear();
    return std::move(balls_);
  }

 private:
  static bool is_stronger(const CausticBall& a, const CausticBall& b) {
    return a.power != b.power ? a.power > b.power : a.sphere < b.sphere;
  }

  std::vector<CausticBall> balls_;  ///< a heap, the weakest first
  double power_ = 0;                ///< of all
  std::uint64_t count_ = 0;         ///< of all
};

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
  const std::vector<Use> uses = uses_of(scene);
  if (uses.empty()) return out;
  const std::vector<Emitter> emitters = emitters_of(scene);
  const Irradiances irradiance{scene, precision == kernel::Precision::kFast ? kSmallestLightInFast : 0};
  StrongestBalls strongest;
  each_sharp(scene, uses, [&](std::uint32_t id, Use use) {
    out.pairs += lights;
    if (use != Use::kSampled) return;
    const Moving moves = moving(scene, id);
    double sum = 0;
    each_light(irradiance, moves, emitters, has_sun, [&](std::uint32_t, double value) { sum += value; });
    if (sum > 0) strongest.add(ball_of(scene, id, moves, sum));
  });
  out.balls = strongest.take();
  for (CausticBall& ball : out.balls) {
    ball.begin = static_cast<std::uint32_t>(out.lights.size());
    double sum = 0;
    each_light(irradiance, moving(scene, ball.sphere), emitters, has_sun, [&](std::uint32_t light, double value) {
      sum += value;
      out.lights.push_back({light, sum, value});
    });
    ball.end = static_cast<std::uint32_t>(out.lights.size());
    for (std::uint32_t i = ball.begin; i < ball.end; ++i) {
      out.lights[i].cumulative /= sum;
      out.lights[i].probability /= sum;
    }
    out.strongest = std::max(out.strongest, ball.power / (ball.radius * ball.radius));
  }
  if (std::find(uses.begin(), uses.end(), Use::kVoid) != uses.end()) add_voids(scene, uses, out.balls);
  return out;
}

}  // namespace orrery::compile
