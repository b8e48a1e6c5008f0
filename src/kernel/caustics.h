// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <initializer_list>
#include <ranges>

#include "kernel/sphere.h"

namespace orrery::kernel {

/// A ball that reflects or refracts sharply, with the lights whose images in it are sampled at diffuse vertices.
struct CausticBall {
  double center[3] = {0, 0, 0};      ///< of the ball's bounding sphere, which encloses its whole motion
  double radius = 1;                 ///< of that sphere
  double power = 0;                  ///< estimate of the light that the ball scatters
  std::uint32_t sphere = 0;          ///< id
  std::uint32_t inner = kNone;       ///< id of the concentric sphere that makes it hollow; kNone: it is not
  std::uint32_t begin = 0, end = 0;  ///< range of Caustics::lights
};

/// A light of a ball.
struct CausticLight {
  std::uint32_t id = 0;    ///< sphere id of an emitter, or kSun
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
  bool has_hollow = false;  ///< a ball has an inner sphere

  /// Whether a ball and a light are a pair.
  bool has(std::uint32_t sphere, std::uint32_t light) const noexcept {
    const CausticBall* const ball = find(sphere);
    if (ball == nullptr) return false;
    const CausticLight* const end = lights + ball->end;
    const CausticLight* const found = std::lower_bound(
        lights + ball->begin, end, light, [](const CausticLight& at, std::uint32_t id) { return at.id < id; });
    return found != end && found->id == light;
  }

  /// Whether a sphere is the inner one of a ball.
  bool is_hollow(std::uint32_t sphere, std::uint32_t inner) const noexcept {
    const CausticBall* const ball = find(sphere);
    return ball != nullptr && ball->inner == inner;
  }

 private:
  /// Null: not listed.
  const CausticBall* find(std::uint32_t sphere) const noexcept {
    const CausticBall* const ball = std::lower_bound(
        balls, balls + count, sphere, [](const CausticBall& at, std::uint32_t id) { return at.sphere < id; });
    return ball != balls + count && ball->sphere == sphere ? ball : nullptr;
  }
};

/// An event of a chain: what the ball, or with kAtVoid the inner sphere of a hollow ball, does to the ray. Chains are
/// sequences of events, the first in the lowest bits.
enum CausticEvent : std::uint32_t { kReflect = 1, kTransmit = 2, kAtVoid = 4 };
inline constexpr int kCausticEventBits = 3;

/// Chains that are sampled: reflection; refraction into the ball and out of it; the same with one reflection inside;
/// the same with a reflection on the void of a hollow ball; the same through the void; from a point in the glass,
/// refraction out of it, away from the ball's centre or past it.
enum CausticChain : int { kReflection, kRefraction, kRainbow, kOffVoid, kThroughVoid, kOutward, kInward };
inline constexpr int kCausticChains = 7;

constexpr std::uint32_t in_sequence(std::initializer_list<std::uint32_t> events) {
  std::uint32_t out = 0;
  for (const std::uint32_t event : std::views::reverse(events)) out = out << kCausticEventBits | event;
  return out;
}

/// The events of each chain.
inline constexpr std::uint32_t kCausticEvents[kCausticChains] = {
    in_sequence({kReflect}),
    in_sequence({kTransmit, kTransmit}),
    in_sequence({kTransmit, kReflect, kTransmit}),
    in_sequence({kTransmit, kReflect | kAtVoid, kTransmit}),
    in_sequence({kTransmit, kTransmit | kAtVoid, kTransmit | kAtVoid, kTransmit}),
    in_sequence({kTransmit}),
    in_sequence({kTransmit})};

/// Number of events of the longest chain.
inline constexpr int kMaxCausticEvents = 4;

/// Distance of a ball, in its radii, up to which every vertex is sampled.
inline constexpr double kCausticReach = 4;

}  // namespace orrery::kernel
