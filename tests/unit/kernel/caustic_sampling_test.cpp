// SPDX-License-Identifier: Apache-2.0
// Light by way of a ball, integrated with the sampled directions, against closed forms and uniform directions.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <numbers>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "kernel/caustics.h"
#include "math/vec3.h"
#include "support/caustic_batch.h"

namespace orrery::test {
namespace {

using kernel::kCausticEvents;
using math::Vec3d;

constexpr double kPi = std::numbers::pi;

/// A ray, and the part of the light that it carries.
struct Carried {
  Vec3d origin, direction;
  double part;
};

double schlick(double cosine, double eta) {
  const double r = (1 - eta) / (1 + eta);
  return r * r + (1 - r * r) * std::pow(1 - cosine, 5);
}

/// The first point of a sphere around the origin on a ray from outside it, or the second on one from inside.
std::optional<Vec3d> reached(double radius, Vec3d from, Vec3d direction, bool inside) {
  const double along = -dot(from, direction);
  const Vec3d closest = from + direction * along;
  const double chord2 = radius * radius - dot(closest, closest);
  if (chord2 < 0 || (along < 0 && !inside)) return {};
  return math::normalized(closest + direction * (inside ? 1 : -1) * std::sqrt(chord2)) * radius;
}

bool is_inside(const CausticPlace& place) { return dot(place.point, place.point) < 1; }

/// The ray that follows the events of a chain from a point outside the ball or in its glass; part 0 if it does not
/// reach the spheres.
Carried followed(const CausticPlace& place, Vec3d direction, std::uint32_t events) {
  Vec3d at = place.point;
  double part = 1;
  bool in_ball = is_inside(place), in_void = false, at_void = false;
  for (; events != 0; events >>= kernel::kCausticEventBits) {
    const bool from_void = at_void;
    at_void = (events & kernel::kAtVoid) != 0;
    const bool from_inside = at_void ? in_void : in_ball;
    const auto hit = reached(at_void ? place.inner : 1, at, direction, from_inside);
    const bool crosses_glass = place.inner > 0 && in_ball && !at_void && !from_void;
    if (!hit || (crosses_glass && reached(place.inner, at, direction, false))) return {at, direction, 0};
    at = *hit;
    const Vec3d normal = math::normalized(at) * (from_inside ? -1 : 1);
    const bool to_denser = from_inside == at_void;
    const double cosine = std::min(-dot(direction, normal), 1.0), eta = to_denser ? 1 / place.eta : place.eta;
    const double sine2 = eta * eta * (1 - cosine * cosine);
    const double reflectance = !place.is_glass ? 1 : sine2 >= 1 ? 1 : schlick(cosine, place.eta);
    if ((events & kernel::kReflect) != 0) {
      part *= reflectance;
      direction = math::normalized(direction + normal * (2 * cosine));
    } else {
      part *= 1 - reflectance;
      direction = math::normalized(direction * eta + normal * (eta * cosine - std::sqrt(std::max(1 - sine2, 0.0))));
      bool& inside = at_void ? in_void : in_ball;
      inside = !inside;
    }
  }
  return {at, direction, part};
}

/// Whether a ray that has left the ball hits the light.
bool hits_light(const CausticPlace& place, const Carried& ray) {
  if (place.inverse_distance == 0) {
    const Vec3d between = ray.direction - place.to_light;
    const double cosine = std::sqrt(1 - place.light_sin * place.light_sin);
    return dot(between, between) <= 2 * place.light_sin * place.light_sin / (1 + cosine);
  }
  const Vec3d to = place.to_light / place.inverse_distance - ray.origin;
  const double along = dot(to, ray.direction), radius = place.light_sin / place.inverse_distance;
  const Vec3d off = to - ray.direction * along;
  return along > 0 && dot(off, off) <= radius * radius;
}

/// The points of Roberts' sequence in three dimensions.
struct Sequence {
  double u = 0.5, v = 0.5, w = 0.5;

  void advance() {
    const auto add = [](double& x, double step) { x = x + step - std::floor(x + step); };
    add(u, 0.8191725133961645);
    add(v, 0.6710436067037893);
    add(w, 0.5497004779019703);
  }
};

using Sampler = CausticDirection (*)(const CausticPlace&, int, double, double, double);

/// Sum over samples, for a light of radiance 1, of cosine times the part of the light, and of the squares.
struct Sum {
  double value = 0, square = 0, largest = 0;
  int count = 0, hits = 0;

  void add(double x) {
    value += x;
    square += x * x;
    largest = std::max(largest, x);
    hits += x > 0 ? 1 : 0;
    ++count;
  }
  double mean() const { return value / count; }
  double error() const { return std::sqrt(std::max(square / count - mean() * mean(), 0.0) / count); }
};

constexpr int kAllChains = -1;

/// The irradiance through one chain, or all, by sampled directions.
Sum irradiance(const CausticPlace& place, Vec3d normal, int chain, int samples, Sampler sample = caustic_direction) {
  Sum sum;
  Sequence s;
  for (int i = 0; i < samples; ++i, s.advance()) {
    const CausticDirection w = sample(place, kernel::kMaxCausticEvents, s.u, s.v, s.w);
    const double cosine = dot(w.direction, normal);
    const bool counts = chain == kAllChains || w.events == kCausticEvents[chain];
    double value = 0;
    if (w.inverse_pdf > 0 && cosine > 0 && counts) {
      const Carried ray = followed(place, w.direction, w.events);
      if (ray.part > 0 && hits_light(place, ray)) value = cosine * ray.part * w.inverse_pdf;
    }
    sum.add(value);
  }
  return sum;
}

/// Of a sun with an irradiance of 1 on a surface that faces it.
double sun_radiance(double sine) { return 1 / (kPi * sine * sine); }

TEST(KernelCausticSampling, AMirrorFacingTheSunReflectsTheClosedForm) {
  for (const double p : {1.2, 2.0, 5.0}) {
    for (const double sine : {1e-4, 1e-5}) {
      const CausticPlace place{{0, p, 0}, {0, 1, 0}, 0, sine, false};
      const double value = irradiance(place, {0, -1, 0}, 0, 20'000).mean() * sun_radiance(place.light_sin);
      EXPECT_NEAR(value * (2 * p - 1) * (2 * p - 1), 1, 1e-4) << p;
    }
  }
}

/// Beyond the focus, an image on the axis; before it, also a ring.
TEST(KernelCausticSampling, GlassBeforeTheSunTransmitsTheClosedForm) {
  constexpr double kEta = 1.5;
  for (const double beta : {1e-3, 1e-4, 1e-5})
    for (const double p : {1.2, 1.4, 1.6, 2.0, 5.0}) {
      const CausticPlace place{{0, -p, 0}, {0, 1, 0}, 0, std::sin(beta), true, kEta};
      const auto theta = [&](double i) {
        return kPi + 2 * i - 2 * std::asin(std::sin(i) / kEta) - std::asin(std::sin(i) / p);
      };
      double want = 0.96 * 0.96 / std::pow(2 * p * (kEta - 1) / kEta - 1, 2);
      double low = 0.05, high = kPi / 2;
      if (theta(high) > kPi && theta(low) < kPi) {
        for (int step = 0; step < 60; ++step) (theta((low + high) / 2) < kPi ? low : high) = (low + high) / 2;
        const double b = std::sin(low), c = std::cos(low);
        const double slope = 2 / c - 2 / std::sqrt(kEta * kEta - b * b) - 1 / std::sqrt(p * p - b * b);
        const double part = (1 - schlick(c, kEta)) * (1 - schlick(std::sqrt(1 - b * b / (kEta * kEta)), kEta));
        want += part * 4 * b / (beta * p * p * slope);
      }
      const double value = irradiance(place, {0, 1, 0}, 1, 50'000).mean() * sun_radiance(place.light_sin);
      // The closed form is that of a vanishing sun.
      EXPECT_NEAR(value / want, 1, 5 * beta + 1e-3) << "p " << p << ", beta " << beta;
      if (beta < 1e-3) continue;  // see compile::kSmallestLightInFast
      const double in_float =
          irradiance(place, {0, 1, 0}, 1, 50'000, caustic_direction_in_float).mean() * sun_radiance(place.light_sin);
      EXPECT_NEAR(in_float / value, 1, 2e-3) << "p " << p;
    }
}

/// Chains with different events.
std::vector<int> chains_of(const CausticPlace& place) {
  using namespace kernel;  // NOLINT(google-build-using-namespace): names of chains
  if (is_inside(place)) return {kOutward};
  if (!place.is_glass) return {kReflection};
  if (place.inner == 0) return {kReflection, kRefraction, kRainbow};
  return {kReflection, kRefraction, kRainbow, kOffVoid, kThroughVoid};
}

/// The part of the light at the impact parameter b that a chain lets through.
double part_of(const CausticPlace& place, int chain, double b) {
  const double eta = place.eta, q = place.inner;
  const auto reflected = [&](double sine) { return sine >= 1 ? 1 : schlick(std::sqrt(1 - sine * sine), eta); };
  if (chain == kernel::kReflection) return place.is_glass ? reflected(b) : 1;
  const double inside = reflected(b / eta), through = (1 - reflected(b)) * (1 - inside);
  if (chain == kernel::kOutward) return 1 - inside;
  const bool meets_void = q > 0 && b < eta * q;
  if (chain == kernel::kRefraction) return meets_void ? 0 : through;
  if (chain == kernel::kRainbow) return meets_void ? 0 : through * inside;
  const double at_void = b < q ? reflected(b / (eta * q)) : 1;
  if (chain == kernel::kOffVoid) return meets_void ? through * at_void : 0;
  return through * (1 - at_void) * (1 - reflected(b / q));
}

/// All light that a ball scatters passes through a sphere around it.
TEST(KernelCausticSampling, TheFluxThroughASphereIsThatOfTheBall) {
  const CausticPlace balls[] = {{{0, 3, 0}, {0, 1, 0}, 0, 0.00465, false},
                                {{0, 3, 0}, {0, 1, 0}, 0, 0.00465, true},
                                {{0, 3, 0}, {0, 1, 0}, 0, 0.00465, true, 1.5, 0.5},
                                {{0, 3, 0}, {0, 1, 0}, 0, 0.00465, true, 1.5, 0.8}};
  for (CausticPlace place : balls) {
    double want[kernel::kCausticChains] = {};
    constexpr int kSteps = 20'000;
    for (int i = 0; i < kSteps; ++i) {
      const double b = (i + 0.5) / kSteps;
      for (const int chain : chains_of(place)) want[chain] += 2 * kPi * b / kSteps * part_of(place, chain, b);
    }
    constexpr double kDistance = 3;
    constexpr int kPoints = 200'000;
    double sum[kernel::kCausticChains] = {};
    Sequence s;
    for (int i = 0; i < kPoints; ++i, s.advance()) {
      const double z = (2 * i + 1.0) / kPoints - 1, r = std::sqrt(1 - z * z);
      const Vec3d out{r, z, 0};
      place.point = out * kDistance;
      const CausticDirection w = caustic_direction(place, kernel::kMaxCausticEvents, s.u, s.v, s.w);
      const Carried ray = followed(place, w.direction, w.events);
      if (!(w.inverse_pdf > 0) || !hits_light(place, ray)) continue;
      const auto chain = std::find(std::begin(kCausticEvents), std::end(kCausticEvents), w.events);
      sum[chain - std::begin(kCausticEvents)] -= dot(w.direction, out) * ray.part * w.inverse_pdf;
    }
    const double area = 4 * kPi * kDistance * kDistance / kPoints;
    for (int chain = 0; chain < kernel::kCausticChains; ++chain) {
      const double found = sum[chain] * area * sun_radiance(place.light_sin);
      EXPECT_NEAR(found, want[chain], 5e-3 * want[chain]) << "chain " << chain << ", void " << place.inner;
    }
  }
}

/// All light that a ball refracts towards a sphere in it passes through this sphere: first inwards, then outwards.
/// Radiance in glass is not multiplied by the square of the index.
TEST(KernelCausticSampling, TheFluxThroughASphereInsideIsThatOfTheBall) {
  constexpr struct { double eta, distance; } kCases[] = {{1.1, 0.95}, {1.5, 0.4}, {1.5, 0.8}, {2.4, 0.3}};
  for (const auto [eta, distance] : kCases) {
    CausticPlace place{{0, distance, 0}, {0, 1, 0}, 0, 0.00465, true, eta};
    const double greatest = std::min(eta * distance, 1.0);
    double want = 0;
    constexpr int kSteps = 20'000;
    for (int i = 0; i < kSteps; ++i) {
      const double b = (i + 0.5) / kSteps * greatest;
      want += 2 * kPi * b * greatest / kSteps * part_of(place, kernel::kOutward, b) / (eta * eta);
    }
    constexpr int kPoints = 100'000;
    double inwards = 0, outwards = 0;
    Sequence s;
    for (int i = 0; i < kPoints; ++i, s.advance()) {
      const double z = (2 * i + 1.0) / kPoints - 1;
      const Vec3d out{std::sqrt(1 - z * z), z, 0};
      place.point = out * distance;
      const CausticDirection w = caustic_direction(place, 1, s.u, s.v, s.w);
      const Carried ray = followed(place, w.direction, w.events);
      if (!(w.inverse_pdf > 0) || !hits_light(place, ray)) continue;
      const double cosine = dot(w.direction, out);
      (cosine > 0 ? inwards : outwards) += std::abs(cosine) * ray.part * w.inverse_pdf;
    }
    const double scale = 4 * kPi * distance * distance / kPoints * sun_radiance(place.light_sin);
    EXPECT_NEAR(inwards * scale, want, 1e-2 * want) << "index " << eta << ", distance " << distance;
    EXPECT_NEAR(outwards * scale, want, 1e-2 * want) << "index " << eta << ", distance " << distance;
  }
}

/// The rainbow of water: the angle of the caustic is known in closed form, and beyond it there is no light.
TEST(KernelCausticSampling, TheRainbowIsWhereDescartesFoundIt) {
  const double eta = 1.333, cos2 = (eta * eta - 1) / 3, i = std::acos(std::sqrt(cos2));
  const double fold = (4 * std::asin(std::sin(i) / eta) - 2 * i) * 180 / kPi;
  EXPECT_NEAR(fold, 42.078, 1e-3);
  const auto intensity = [&](double angle) {
    const double p = 1e6, a = angle * kPi / 180;
    const Vec3d out{std::sin(a), std::cos(a), 0};
    const CausticPlace place{out * p, {0, 1, 0}, 0, 1e-4, true, eta};
    return irradiance(place, -out, 2, 20'000).mean() * sun_radiance(1e-4) * p * p;
  };
  // The half angle of the sun is 0.0057 degrees, that of the ball at this distance 0.00006.
  EXPECT_NEAR(intensity(42.07), 1.01, 0.02);
  EXPECT_GT(intensity(fold - 0.001), intensity(42.07));
  EXPECT_EQ(intensity(fold + 0.01), 0);
}

Vec3d random_direction(std::mt19937& random) {
  std::uniform_real_distribution<double> unit;
  const double z = 1 - 2 * unit(random), turn = 2 * kPi * unit(random), r = std::sqrt(1 - z * z);
  return {r * std::cos(turn), r * std::sin(turn), z};
}

/// Points, balls and lights in all proportions: touching, near and far, on the axis and off it.
std::pair<CausticPlace, Vec3d> random_place(std::mt19937& random) {
  std::uniform_real_distribution<double> unit;
  CausticPlace place;
  place.to_light = random_direction(random);
  if (unit(random) < 0.3) {
    place.light_sin = std::sin(std::pow(10, -1.7 + 1.5 * unit(random)));
  } else {
    const double radius = std::pow(10, -1.5 + 2 * unit(random));
    const double distance = 1 + radius + (unit(random) < 0.1 ? 0 : std::pow(10, -3 + 4 * unit(random)));
    place.inverse_distance = 1 / distance;
    place.light_sin = radius / distance;
  }
  place.is_glass = unit(random) < 0.75;
  place.eta = 1.05 + 1.6 * unit(random) * unit(random);
  if (place.is_glass && unit(random) < 0.4) place.inner = 0.05 + 0.94 * unit(random);
  Vec3d out = random_direction(random);
  if (unit(random) < 0.5)
    out = math::normalized(-place.to_light + random_direction(random) * (unit(random) * unit(random) * 0.8));
  if (unit(random) < 0.05) out = -place.to_light;
  place.point = out * (unit(random) < 0.1 ? 1 : 1 + std::pow(10, -4 + 5 * unit(random)));
  return {place, math::normalized(-out + random_direction(random) * 1.5)};
}

/// The same with points in the glass, also in that of a hollow ball.
std::pair<CausticPlace, Vec3d> random_place_in_glass(std::mt19937& random) {
  std::uniform_real_distribution<double> unit;
  auto [place, normal] = random_place(random);
  place.is_glass = true;
  const double distance = unit(random) < 0.1 ? std::pow(10, -6 * unit(random)) : 0.02 + 0.98 * unit(random);
  place.point = math::normalized(place.point) * distance;
  if (place.inner > 0) place.inner = std::min(place.inner, distance) * (0.3 + 0.7 * unit(random));
  return {place, math::normalized(random_direction(random))};
}

/// The irradiance through all chains, by uniform directions to the ball.
Sum brute_irradiance(const CausticPlace& place, Vec3d normal, int samples, std::mt19937& random) {
  std::uniform_real_distribution<double> unit;
  const double p = std::max(math::length(place.point), 1.0), sine = 1 / p;
  const double cone = is_inside(place) ? 2 : sine * sine / (1 + std::sqrt((1 - sine) * (1 + sine)));
  const Vec3d axis = -math::normalized(place.point);
  const Vec3d across = math::normalized(cross(axis, std::abs(axis.x) < 0.5 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0}));
  const Vec3d up = cross(axis, across);
  Sum sum;
  for (int i = 0; i < samples; ++i) {
    const double versine = cone * unit(random), turn = 2 * kPi * unit(random);
    const double r = std::sqrt(versine * (2 - versine));
    const Vec3d w = axis * (1 - versine) + (across * std::cos(turn) + up * std::sin(turn)) * r;
    const double cosine = dot(w, normal);
    double part = 0;
    for (const int chain : chains_of(place)) {
      const Carried ray = followed(place, w, kCausticEvents[chain]);
      if (cosine > 0 && hits_light(place, ray)) part += ray.part;
    }
    sum.add(std::max(cosine, 0.0) * part * 2 * kPi * cone);
  }
  return sum;
}

using Places = std::pair<CausticPlace, Vec3d> (*)(std::mt19937&);

/// Where uniform directions find the light, they find as much as the sampled ones. ORRERY_CAUSTIC_VERTICES sets the
/// number of sampled directions.
void expect_unbiased(Sampler sample, Places places, const char* name) {
  const char* const given = std::getenv("ORRERY_CAUSTIC_VERTICES");
  constexpr int kTests = 160;
  const int samples = given != nullptr ? static_cast<int>(std::atof(given) / kTests) : 3'000;
  std::mt19937 random(7);
  int compared = 0;
  double squares = 0, largest_z = 0, largest = 0;
  for (int test = 0; test < kTests; ++test) {
    const auto [place, normal] = places(random);
    const Sum brute = brute_irradiance(place, normal, 20'000, random);
    if (brute.hits < 50) continue;
    const Sum sampled = irradiance(place, normal, kAllChains, samples, sample);
    const double z = (sampled.mean() - brute.mean()) / std::hypot(brute.error(), sampled.error());
    EXPECT_LT(std::abs(z), 4.5) << name << ", test " << test << ": " << sampled.mean() << " and " << brute.mean();
    squares += z * z;
    ++compared;
    largest_z = std::max(largest_z, std::abs(z));
    largest = std::max(largest, sampled.largest / brute.mean());
  }
  EXPECT_GT(compared, 40);
  EXPECT_LT(std::sqrt(squares / compared), 1.2);
  std::printf("%s: %d places, largest |z| %.2f, rms z %.2f, largest contribution / mean %.1f\n", name, compared,
              largest_z, std::sqrt(squares / compared), largest);
}

TEST(KernelCausticSampling, FindsAllLightInDouble) {
  expect_unbiased(caustic_direction, random_place, "double");
  expect_unbiased(caustic_direction, random_place_in_glass, "double, in glass");
}
TEST(KernelCausticSampling, FindsAllLightInFloat) {
  expect_unbiased(caustic_direction_in_float, random_place, "float");
  expect_unbiased(caustic_direction_in_float, random_place_in_glass, "float, in glass");
}

}  // namespace
}  // namespace orrery::test
