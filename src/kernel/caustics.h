// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

namespace orrery::kernel {

/// A ball that reflects or refracts sharply, with the lights whose images in it are sampled at diffuse vertices.
struct CausticBall {
  double center[3] = {0, 0, 0};      ///< of the ball's bounding sphere, which encloses its whole motion
  double radius = 1;                 ///< of that sphere
  double power = 0;                  ///< estimate of the light that the ball scatters
  std::uint32_t sphere = 0;          ///< id
  std::uint32_t begin = 0, end = 0;  ///< range of Caustics::lights
};

/// A light of a ball.
struct CausticLight {
  std::uint32_t id = 0;    ///< sphere id of an emitter; kNoSphere: the sun
  double cumulative = 0;   ///< share of the ball's power that comes from this light and those before it; 1 for the last
  double probability = 0;  ///< share of this light
};

/// The pairs of balls and lights of a scene, by ascending sphere, then ascending light. Light that a path finds after
/// it has left a diffuse vertex by a chain of a listed pair counts zero, since it is sampled at that vertex.
///
/// Reference  docs/decisions/0040
struct Caustics {
  /// Maximum number of balls: the importance of each is computed at each diffuse vertex.
  static constexpr std::uint32_t kMaxBalls = 128;

  const CausticBall* balls = nullptr;
  std::uint32_t count = 0;  ///< of balls
  const CausticLight* lights = nullptr;
  /// Reciprocal of the importance, power / distance^2, from which on every vertex is sampled.
  double inverse_reference = 0;

  /// Whether a ball and a light are a pair.
  bool has(std::uint32_t sphere, std::uint32_t light) const noexcept {
    const CausticBall* const ball = std::lower_bound(
        balls, balls + count, sphere, [](const CausticBall& at, std::uint32_t id) { return at.sphere < id; });
    if (ball == balls + count || ball->sphere != sphere) return false;
    const CausticLight* const end = lights + ball->end;
    const CausticLight* const found = std::lower_bound(
        lights + ball->begin, end, light, [](const CausticLight& at, std::uint32_t id) { return at.id < id; });
    return found != end && found->id == light;
  }
};

/// An event of a chain: what the ball does to the ray. Chains are sequences of events, the first in the lowest bits.
enum CausticEvent : std::uint32_t { kReflect = 1, kTransmit = 2 };
inline constexpr int kCausticEventBits = 2;

/// The events of the chain that enters the ball, is reflected `k - 1` times inside and leaves it; k = 0: is reflected.
constexpr std::uint32_t caustic_events(int k) {
  if (k == 0) return kReflect;
  std::uint32_t events = kTransmit;
  for (int i = 1; i < k; ++i) events = events << kCausticEventBits | kReflect;
  return events << kCausticEventBits | kTransmit;
}

/// Number of chains that are sampled: reflection; refraction into the ball and out of it; the same with one reflection
/// inside.
inline constexpr int kCausticChains = 3;

/// Distance of a ball, in its radii, up to which every vertex is sampled.
inline constexpr double kCausticReach = 4;

}  // namespace orrery::kernel
