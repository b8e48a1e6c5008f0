// SPDX-License-Identifier: Apache-2.0
// Compares ray-sphere intersection with multi-precision arithmetic, in regimes where other renderers fail. Prints the
// table of docs/numerics.md.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <random>
#include <string>

#include "kernel/isa.h"
#include "support/big_real.h"
#include "support/intersect_batch.h"
#include "support/quad_real.h"
#include "support/vec3_of.h"

namespace orrery::test {
namespace {

using kernel::kCamera;
using kernel::kPacketSize;

/// Band in which the rounding of the input doubles alone decides between hit and miss, in radii.
constexpr double kGrazingBand = 1e-15;

/// |computed - true hit point| x cos(incidence), in radii, as stated in docs/numerics.md.
constexpr double kHitPointBound = 4.5e-16;

/// |computed - true distance| x cos(incidence), relative to the larger of the distance and the radius.
constexpr double kDistanceBound = 5e-16;

/// |distance of the hit point from the centre / radius - 1|, also at grazing incidence.
constexpr double kLengthBound = 4e-16;

int rays_per_regime() {
  const char* wanted = std::getenv("ORRERY_NUMERIC_RAYS");
  return wanted != nullptr ? std::atoi(wanted) : 100000;
}

struct Random {
  std::mt19937_64 engine{20240817};
  double uniform(double a, double b) { return a + (b - a) * static_cast<double>(engine() >> 11) * 0x1p-53; }
  double log_uniform(double a, double b) { return std::exp(uniform(std::log(a), std::log(b))); }
  void direction(double (&d)[3]) {
    for (;;) {
      double length2 = 0;
      for (double& x : d) {
        x = uniform(-1, 1);
        length2 += x * x;
      }
      if (length2 > 1 || length2 < 1e-4) continue;
      for (double& x : d) x /= std::sqrt(length2);
      return;
    }
  }
};

/// One ray and one sphere.
struct Case {
  kernel::Sphere sphere;
  double base[3] = {0, 0, 0}, offset[3] = {0, 0, 0}, direction[3] = {0, 0, 1};
  std::uint64_t self = kCamera;
};

struct Regime {
  std::string name;
  std::function<Case(Random&)> make;
};

/// A ray that starts `distance` radii from the centre and passes it at `impact` radii.
Case aimed(Random& random, double radius, double distance, double impact, double scene_offset, double length) {
  Case c;
  double to_center[3], side[3], where[3];
  random.direction(to_center);
  random.direction(where);
  do random.direction(side);
  while (std::abs(side[0] * to_center[0] + side[1] * to_center[1] + side[2] * to_center[2]) > 0.9);
  double along = 0, square = 0;
  for (int i = 0; i < 3; ++i) along += side[i] * to_center[i];
  for (int i = 0; i < 3; ++i) {
    side[i] -= along * to_center[i];
    square += side[i] * side[i];
  }
  c.sphere.radius = radius;
  double center[3];
  for (int i = 0; i < 3; ++i) {
    center[i] = where[i] * scene_offset;
    c.base[i] = center[i] - to_center[i] * distance * radius;
    c.direction[i] = (to_center[i] * distance + side[i] / std::sqrt(square) * impact) * radius;
  }
  double norm = 0;
  for (const double x : c.direction) norm += x * x;
  for (double& x : c.direction) x *= length / std::sqrt(norm);
  c.sphere.x = center[0];
  c.sphere.y = center[1];
  c.sphere.z = center[2];
  return c;
}

/// A ray that leaves the sphere's own surface, or that of a neighbour at a gap of `gap` radii.
Case leaving(Random& random, double radius, double scene_offset, double gap, bool own) {
  Case c;
  double n[3], where[3];
  random.direction(n);
  random.direction(where);
  random.direction(c.direction);
  double center[3] = {where[0] * scene_offset, where[1] * scene_offset, where[2] * scene_offset};
  c.sphere = {center[0], center[1], center[2], radius};
  c.self = own ? 0 : 1;
  for (int i = 0; i < 3; ++i) {
    // The neighbour has the same radius and its centre along n; the ray starts at its point closest to this sphere.
    c.base[i] = own ? center[i] : center[i] + n[i] * radius * (2 + gap);
    c.offset[i] = (own ? n[i] : -n[i]) * radius;
  }
  return c;
}

std::vector<Regime> regimes() {
  const auto any_impact = [](Random& r) { return r.uniform(0, 1.2); };
  std::vector<Regime> list;
  list.push_back({"book scene", [=](Random& r) {
                    return aimed(r, r.log_uniform(0.1, 1000), r.log_uniform(1.01, 100), any_impact(r), 10, 1);
                  }});
  list.push_back({"radius 1e-12 .. 1e12", [=](Random& r) {
                    return aimed(r, r.log_uniform(1e-12, 1e12), r.log_uniform(1.01, 1e3), any_impact(r), 0, 1);
                  }});
  list.push_back({"distance / radius to 1e12",
                  [=](Random& r) { return aimed(r, 1, r.log_uniform(1e3, 1e12), any_impact(r), 0, 1); }});
  list.push_back({"offset to 1e9", [=](Random& r) {
                    return aimed(r, 1, r.log_uniform(1.01, 1e3), any_impact(r), r.log_uniform(1e3, 1e9), 1);
                  }});
  list.push_back({"grazing to 1e-15", [=](Random& r) {
                    const double away = r.log_uniform(1e-15, 1e-3);
                    return aimed(r, 1, r.log_uniform(1.5, 100), r.uniform(0, 1) < 0.5 ? 1 - away : 1 + away, 0, 1);
                  }});
  list.push_back({"direction 1e-20 .. 1e20", [=](Random& r) {
                    return aimed(r, 1, r.log_uniform(1.01, 1e3), any_impact(r), 0, r.log_uniform(1e-20, 1e20));
                  }});
  list.push_back({"origin inside", [=](Random& r) {
                    return aimed(r, r.log_uniform(1e-6, 1e6), r.uniform(0, 0.99), r.uniform(0, 0.1), 0, 1);
                  }});
  list.push_back({"origin just outside or inside", [=](Random& r) {
                    const double away = r.log_uniform(1e-12, 1e-3);
                    return aimed(r, 1, r.uniform(0, 1) < 0.5 ? 1 + away : 1 - away, r.uniform(0, 0.9), 0, 1);
                  }});
  list.push_back(
      {"leaving its own surface", [=](Random& r) { return leaving(r, r.log_uniform(1e-12, 1e12), 0, 0, true); }});
  list.push_back({"leaving another, offset to 1e9",
                  [=](Random& r) { return leaving(r, 1, r.log_uniform(1e3, 1e9), r.log_uniform(1e-6, 1), false); }});
  list.push_back(
      {"its own, offset to 1e9", [=](Random& r) { return leaving(r, 1, r.log_uniform(1e3, 1e9), 0, true); }});
  return list;
}

/// Reference solution of one case, in multi-precision arithmetic.
struct Truth {
  bool hit = false;
  bool in_band = false;  ///< undecidable in double: grazing, or starting on the surface of another sphere
  double offset[3] = {0, 0, 0};
  double distance = 0;  ///< in units of the direction's length
  double cos_incidence = 0;
};

template <class Real>
Truth truth(const Case& c, const kernel::RayPacket<double>& p, int lane) {
  using Vec = Vec3Of<Real>;
  const Vec origin = Vec{p.origin[0][lane], p.origin[1][lane], p.origin[2][lane]} +
                     Vec{p.origin_low[0][lane], p.origin_low[1][lane], p.origin_low[2][lane]};
  const Vec direction{c.direction[0], c.direction[1], c.direction[2]};
  const Real radius = c.sphere.radius, dd = dot(direction, direction);
  Truth out;
  const auto set = [&](const Vec& m) {
    out.offset[0] = m.x.to_double();
    out.offset[1] = m.y.to_double();
    out.offset[2] = m.z.to_double();
  };
  if (c.self == 0) {
    // The other end of the chord that starts at the stored point. Rounding puts that point, and thus the other end,
    // about 1e-16 radii off the sphere; the reference hit point lies on the sphere.
    const Vec start{c.offset[0], c.offset[1], c.offset[2]};
    const Real t = Real(-2.0) * dot(start, direction) / dd;
    out.hit = Real(0.0) < t;
    out.distance = t.to_double();
    const Vec m = start + direction * t;
    set(m * (radius / sqrt(dot(m, m))));
    out.cos_incidence = std::abs((dot(m, direction) / sqrt(dot(m, m) * dd)).to_double());
    return out;
  }
  const Vec f = Vec{c.sphere.x, c.sphere.y, c.sphere.z} - origin;
  const Real middle = dot(f, direction) / dd;
  const Vec l = f - direction * middle;
  const Real impact2 = dot(l, l), discriminant = radius * radius - impact2;
  const double impact = (sqrt(impact2) / radius - 1.0).to_double();
  const double surface = (sqrt(dot(f, f)) / radius - 1.0).to_double();
  out.in_band = std::abs(impact) < kGrazingBand || std::abs(surface) < kGrazingBand;
  if (discriminant < 0.0) return out;
  const Real half = sqrt(discriminant / dd);
  const Real entry = middle - half, exit = middle + half;
  out.hit = Real(0.0) < exit;
  const Real t = Real(0.0) < entry ? entry : exit;
  out.distance = t.to_double();
  set(direction * t - f);
  out.cos_incidence = (sqrt(discriminant) / radius).to_double();
  return out;
}

struct Tally {
  long rays = 0, wrong = 0, skipped = 0, differing = 0, doubtful = 0;
  double worst = 0;           ///< hit point error x cos(incidence), in radii
  double worst_length = 0;    ///< error of the hit point's distance from the centre, in radii
  double worst_distance = 0;  ///< distance error x cos(incidence), relative to the larger of distance and radius
};

/// Intersects a regime's rays in the kernel, with all lanes and with one, and compares with the reference.
Tally run(const Regime& regime, kernel::Precision precision, int rays) {
  Random random;
  Tally tally;
  for (int done = 0; done < rays; done += kPacketSize) {
    Case cases[kPacketSize];
    kernel::RayPacket<double> packet;
    kernel::Sphere spheres[kPacketSize];
    std::uint64_t ids[kPacketSize] = {};
    for (int i = 0; i < kPacketSize; ++i) {
      cases[i] = regime.make(random);
      spheres[i] = cases[i].sphere;
      set_ray(packet, i, cases[i].base, cases[i].offset, cases[i].direction, cases[i].self);
    }
    const Intersections found = intersect_batch(precision, test::Lanes::kAll, packet, spheres, ids);
    const Intersections one = intersect_batch(precision, test::Lanes::kOne, packet, spheres, ids);
    for (int i = 0; i < kPacketSize; ++i) {
      ++tally.rays;
      if (precision == kernel::Precision::kExact &&
          (one.hit[i] != found.hit[i] ||
           (one.hit[i] && (one.distance[i] != found.distance[i] || one.offset[0][i] != found.offset[0][i]))))
        ++tally.differing;
      const Truth t = truth<QuadReal>(cases[i], packet, i);
      // Check the 113-bit reference against 320 bits.
      if (tally.rays % 64 == 0) {
        const Truth more = truth<BigReal>(cases[i], packet, i);
        tally.doubtful += more.hit != t.hit || more.in_band != t.in_band;
        for (int axis = 0; axis < 3 && more.hit; ++axis) tally.doubtful += more.offset[axis] != t.offset[axis];
      }
      if (t.in_band) {
        ++tally.skipped;
        continue;
      }
      if (t.hit != found.hit[i]) {
        ++tally.wrong;
        continue;
      }
      if (!t.hit) continue;
      const double r = cases[i].sphere.radius;
      double square = 0;
      for (int axis = 0; axis < 3; ++axis) {
        const double e = (found.offset[axis][i] - t.offset[axis]) / r;
        square += e * e;
      }
      tally.worst = std::max(tally.worst, std::sqrt(square) * t.cos_incidence);
      const long double x = found.offset[0][i], y = found.offset[1][i], z = found.offset[2][i];
      tally.worst_length =
          std::max(tally.worst_length, static_cast<double>(std::abs(std::sqrt(x * x + y * y + z * z) / r - 1)));
      const double* const d = cases[i].direction;
      const double radius_long = r / std::hypot(d[0], d[1], d[2]);
      tally.worst_distance = std::max(tally.worst_distance, std::abs(found.distance[i] - t.distance) * t.cos_incidence /
                                                                std::max(t.distance, radius_long));
    }
  }
  return tally;
}

void expect_exact_hits(int rays) {
  std::printf("%-32s %10s %8s %8s %14s %14s %14s\n", ("regime, " + kernel::isa_name()).c_str(), "rays", "in band",
              "wrong", "point x cos", "distance x cos", "off the sphere");
  for (const Regime& regime : regimes()) {
    const Tally t = run(regime, kernel::Precision::kExact, rays);
    std::printf("%-32s %10ld %8ld %8ld %14.2e %14.2e %14.2e\n", regime.name.c_str(), t.rays, t.skipped, t.wrong,
                t.worst, t.worst_distance, t.worst_length);
    EXPECT_EQ(t.wrong, 0) << regime.name;
    EXPECT_EQ(t.doubtful, 0) << regime.name << ": 113 and 320 bits differ";
    EXPECT_EQ(t.differing, 0) << regime.name << ": one lane and all lanes differ";
    EXPECT_LE(t.worst, kHitPointBound) << regime.name;
    EXPECT_LE(t.worst_distance, kDistanceBound) << regime.name;
    EXPECT_LE(t.worst_length, kLengthBound) << regime.name;
    EXPECT_LT(t.skipped, t.rays / 10) << regime.name << ": too many rays in the band";
  }
}

TEST(Extremes, HitOrMissAndHitPointError) { expect_exact_hits(rays_per_regime()); }

/// The same bounds without fused multiply-add, and with fewer lanes.
TEST(Extremes, EveryInstructionSetIsAsExact) {
  for (const std::string& isa : kernel::available_isas()) {
    if (isa == kernel::available_isas().front()) continue;
    ASSERT_TRUE(kernel::limit_isa(isa));
    expect_exact_hits(rays_per_regime() / 4);
  }
  kernel::limit_isa("");
}

/// The same test rejects the book's quadratic formula, which shows that it can fail.
TEST(Extremes, BookFormulaFails) {
  std::printf("%-32s %10s %8s %8s %14s\n", "regime (the book's formula)", "rays", "in band", "wrong", "error x cos");
  long wrong = 0;
  constexpr int kRays = 8000;
  for (const Regime& regime : regimes()) {
    const Tally t = run(regime, kernel::Precision::kBook, kRays);
    std::printf("%-32s %10ld %8ld %8ld %14.2e\n", regime.name.c_str(), t.rays, t.skipped, t.wrong, t.worst);
    wrong += t.wrong;
  }
  EXPECT_GT(wrong, kRays / 10);
}

/// Two equal spheres with a gap between them: a ray from one sphere towards the centre of the other must hit it.
TEST(Extremes, RaysAcrossNarrowGapsHit) {
  Random random;
  for (const double gap : {0.0, 1e-15, 1e-14, 1e-13, 1e-10, 1e-6}) {
    for (const double offset : {0.0, 1e3, 1e9}) {
      // Far from the origin doubles cannot represent the gap, so only the rounded positions are tested.
      if (offset > 0 && gap != 0) continue;
      for (int i = 0; i < 20000; i += kPacketSize) {
        kernel::RayPacket<double> packet;
        kernel::Sphere spheres[kPacketSize];
        std::uint64_t ids[kPacketSize] = {};
        bool outside[kPacketSize];
        for (int lane = 0; lane < kPacketSize; ++lane) {
          const double exponent = random.uniform(0, 1) < 0.5 ? 0 : random.uniform(-20, 20);
          const Case c = leaving(random, std::exp2(std::round(exponent)), offset, gap, false);
          spheres[lane] = c.sphere;
          double direction[3];
          for (int axis = 0; axis < 3; ++axis) direction[axis] = -c.offset[axis] * -1.0;
          const Vec3Of<BigReal> f = Vec3Of<BigReal>{c.sphere.x, c.sphere.y, c.sphere.z} -
                                    (Vec3Of<BigReal>{c.base[0], c.base[1], c.base[2]} +
                                     Vec3Of<BigReal>{c.offset[0], c.offset[1], c.offset[2]});
          outside[lane] = BigReal(c.sphere.radius) * c.sphere.radius < dot(f, f);
          set_ray(packet, lane, c.base, c.offset, direction, c.self);
        }
        const Intersections found = intersect_batch(kernel::Precision::kExact, test::Lanes::kAll, packet, spheres, ids);
        for (int lane = 0; lane < kPacketSize; ++lane) {
          ASSERT_TRUE(found.hit[lane]) << gap;
          if (gap >= 1e-13 && outside[lane]) {
            // The near side is hit, not the far side.
            ASSERT_LT(found.distance[lane], 1.0) << gap;
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace orrery::test
