// SPDX-License-Identifier: Apache-2.0
// Compares ray-rod intersection with multi-precision arithmetic in 29 regimes, and prints the table of
// docs/numerics.md. ORRERY_NUMERIC_RAYS sets the number of rays in each regime.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "kernel/isa.h"
#include "kernel/rod.h"
#include "support/big_real.h"
#include "support/intersect_batch.h"
#include "support/quad_real.h"
#include "support/rod_batch.h"
#include "support/vec3_of.h"

namespace orrery::test {
namespace {

using kernel::kCamera;
using kernel::kPacketSize;
using kernel::Rod;

/// Largest distance from silhouette or surface, in radii, at which rounding may decide between hit and miss.
constexpr double kUndecided = 1e-15;

// The bounds that docs/numerics.md states.
constexpr double kRodPointBound = 8e-16;      ///< |point - true point| x cos(incidence), in radii
constexpr double kRodDistanceBound = 8e-16;   ///< |t - true t| x cos(incidence), relative to the larger of t and radius
constexpr double kRodSurfaceBound = 4.5e-16;  ///< distance of the point from the rod's surface, in radii
constexpr double kRodNormalBound = 6e-16;     ///< |normal - true normal| x cos(incidence)

int rods_per_regime(int otherwise) {
  const char* wanted = std::getenv("ORRERY_NUMERIC_RAYS");
  return wanted != nullptr ? std::atoi(wanted) : otherwise;
}

using Three = std::array<double, 3>;

double dot3(const Three& a, const Three& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Three cross3(const Three& a, const Three& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Three unit3(const Three& a) {
  const double length = std::sqrt(dot3(a, a));
  return {a[0] / length, a[1] / length, a[2] / length};
}
/// a + b s.
Three plus3(const Three& a, const Three& b, double s) { return {a[0] + b[0] * s, a[1] + b[1] * s, a[2] + b[2] * s}; }

struct RodRandom {
  std::mt19937_64 engine{20251125};
  double uniform(double a, double b) { return a + (b - a) * static_cast<double>(engine() >> 11) * 0x1p-53; }
  /// Uniform exponent of ten.
  double decades(double from, double to) { return std::pow(10.0, uniform(from, to)); }
  double sign() { return (engine() & 1) != 0 ? 1 : -1; }
  Three direction() {
    for (;;) {
      const Three d = {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
      if (const double square = dot3(d, d); square > 0.01 && square < 1) return unit3(d);
    }
  }
  Three perpendicular(const Three& to) {
    for (;;) {
      const Three d = direction(), across = plus3(d, to, -dot3(d, to) / dot3(to, to));
      if (dot3(across, across) > 0.01) return unit3(across);
    }
  }
};

/// One ray and one rod. The ray's origin is the sum of `origin` and `low`.
struct RodCase {
  Rod rod;
  Three origin{0, 0, 0}, low{0, 0, 0}, direction{0, 0, 1};

  Three a() const { return {rod.a[0], rod.a[1], rod.a[2]}; }
  Three axis() const { return {rod.b[0] - rod.a[0], rod.b[1] - rod.a[1], rod.b[2] - rod.a[2]}; }
};

Rod rod_between(const Three& a, const Three& b, double radius) {
  Rod rod;
  std::copy_n(a.data(), 3, rod.a);
  std::copy_n(b.data(), 3, rod.b);
  rod.radius = radius;
  return rod;
}

/// Splits a point into a double and the rest.
void set_origin(RodCase& c, int axis, QuadReal x) {
  const auto i = static_cast<std::size_t>(axis);
  c.origin[i] = x.to_double();
  c.low[i] = (x - c.origin[i]).to_double();
}

/// What aimed() makes. Lengths are in radii.
struct Aim {
  double radius = 1, length = 10, distance = 10, offset = 10;
  double place = 0.5;   ///< the point of the axis that the ray passes: 0 at a, 1 at b
  double impact = 0.5;  ///< distance at which it passes
  double sine = -1;     ///< of the angle to the axis; negative: any
};

RodCase aimed(RodRandom& random, const Aim& aim) {
  RodCase c;
  const Three along = random.direction();
  Three d = random.direction();
  if (aim.sine >= 0)
    d = unit3(plus3(Three{random.perpendicular(along)}, along,
                    random.sign() * std::sqrt(1 - aim.sine * aim.sine) / std::max(aim.sine, 1e-300)));
  if (aim.sine == 0) d = along;
  const Three a = plus3({0, 0, 0}, random.direction(), aim.offset * aim.radius);
  c.rod = rod_between(a, plus3(a, along, aim.length * aim.radius), aim.radius);
  // Between the ends, the shortest way from the axis to the ray is perpendicular to both.
  Three side = random.perpendicular(d);
  if (const Three normal = cross3(d, along); aim.place > 0 && aim.place < 1 && dot3(normal, normal) > 0)
    side = unit3(normal);
  const Three passed = plus3(plus3(a, c.axis(), aim.place), side, aim.impact * aim.radius);
  c.origin = plus3(passed, d, -aim.distance * aim.radius);
  c.direction = d;
  return c;
}

/// A ray that leaves a point `gap` radii outside the surface.
RodCase leaving(RodRandom& random, double radius, double length, double offset, double gap) {
  RodCase c;
  const Three along = random.direction(), a = plus3({0, 0, 0}, random.direction(), offset * radius);
  c.rod = rod_between(a, plus3(a, along, length * radius), radius);
  const double place = random.uniform(-0.2, 1.2), on_axis = std::clamp(place, 0.0, 1.0);
  Three out = random.perpendicular(along);
  if (on_axis != place) {
    out = random.direction();
    if (dot3(out, along) * (place < 0 ? -1 : 1) < 0) out = plus3({0, 0, 0}, out, -1);
  }
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const QuadReal from = c.rod.a[i], to = c.rod.b[i];
    set_origin(c, i,
               from + QuadReal(on_axis) * (to - from) + QuadReal(out[k]) * (QuadReal(radius) * (QuadReal(1.0) + gap)));
  }
  c.direction = random.direction();
  return c;
}

/// A ray towards a point `beyond` radii beyond the plane in which an end begins, at `impact` radii from the axis, on
/// the side from which the ray comes; or at the silhouette.
RodCase at_seam(RodRandom& random, double length, double beyond, double impact, double distance, bool is_grazing) {
  RodCase c;
  const Three along = random.direction(), a = plus3({0, 0, 0}, random.direction(), 10);
  c.rod = rod_between(a, plus3(a, along, length), 1);
  c.direction = random.direction();
  Three side = random.perpendicular(along);
  if (is_grazing) side = unit3(cross3(c.direction, along));
  if (!is_grazing && dot3(c.direction, side) > 0) c.direction = plus3({0, 0, 0}, c.direction, -1);
  const bool at_b = random.sign() > 0;
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    set_origin(c, i,
               QuadReal(at_b ? c.rod.b[i] : c.rod.a[i]) + QuadReal(along[k]) * beyond + QuadReal(side[k]) * impact -
                   QuadReal(c.direction[k]) * distance);
  }
  return c;
}

/// A ray that leaves a larger sphere around an end, close to where the rod comes out of it.
RodCase leaving_atom(RodRandom& random, double gap) {
  RodCase c;
  const double atom = random.decades(0, 1.7) * 1.001, offset = random.sign() > 0 ? 10 : random.decades(0, 9);
  const Three along = random.direction(), a = plus3({0, 0, 0}, random.direction(), offset);
  c.rod = rod_between(a, plus3(a, along, atom * random.uniform(2, 3)), 1);
  const Three u = unit3(c.axis()), side = random.perpendicular(u);
  const double sine = std::min(1.0, (1 + gap) / atom), cosine = std::sqrt(1 - sine * sine);
  const Three out = plus3(plus3({0, 0, 0}, side, sine * atom), u, cosine * atom);
  c.direction = random.direction();
  if (dot3(c.direction, out) < 0) c.direction = plus3({0, 0, 0}, c.direction, -1);
  for (int i = 0; i < 3; ++i) set_origin(c, i, QuadReal(c.rod.a[i]) + out[static_cast<std::size_t>(i)]);
  return c;
}

struct RodRegime {
  std::string name;
  std::function<RodCase(RodRandom&)> make;
  /// The ray is within rounding of the surface over a long way: the entry slides along it, but stays on the surface.
  bool slides = false;
};

std::vector<RodRegime> rod_regimes() {
  using R = RodRandom;
  const auto impact = [](R& r) { return r.uniform(0, 1.1); };
  const auto place = [](R& r) { return r.uniform(-0.3, 1.3); };
  const auto near = [](R& r, double from, double to) { return 1 + r.sign() * r.decades(from, to); };
  const auto far_place = [](R& r) { return r.uniform(-1e-3, 1.001); };
  const auto sine = [](R& r) { return r.decades(-16, -1); };
  std::vector<RodRegime> list;
  const auto add = [&](const char* name, auto make) { list.push_back({name, make}); };
  add("bonds", [=](R& r) { return aimed(r, {0.15, 10, r.uniform(5, 100), 20, place(r), impact(r)}); });
  add("length 1e-3..1e3, radius 1e-12..1e12", [=](R& r) {
    return aimed(r, {r.decades(-12, 12), r.decades(-3, 3), r.decades(0, 3), 10, place(r), impact(r)});
  });
  add("length 0", [=](R& r) { return aimed(r, {1, 0, r.decades(0, 3), 10, 0, impact(r)}); });
  add("length 0, distance 1e3..1e12", [=](R& r) { return aimed(r, {1, 0, r.decades(3, 12), 10, 0, impact(r)}); });
  add("length 1e-18..1e-3", [=](R& r) {
    return aimed(r, {1, r.decades(-18, -3), r.decades(0, 3), r.sign() > 0 ? 0.0 : 1.0, place(r), impact(r)});
  });
  add("length 1e3..1e9", [=](R& r) {
    return aimed(r, {1, r.decades(3, 9), r.decades(0, 3), 10, far_place(r), impact(r)});
  });
  add("length 1e3..1e9, distance to 1e9", [=](R& r) {
    return aimed(r, {1, r.decades(3, 9), r.decades(0, 9), 10, far_place(r), impact(r)});
  });
  add("distance to 1e12", [=](R& r) {
    return aimed(r, {1, r.decades(-1, 3), r.decades(3, 12), 10, place(r), impact(r)});
  });
  add("offset 1e9", [=](R& r) { return aimed(r, {1, r.decades(-1, 3), r.decades(0, 3), 1e9, place(r), impact(r)}); });
  add("offset 1e9, length 1e3..1e9", [=](R& r) {
    return aimed(r, {1, r.decades(3, 9), r.decades(0, 6), 1e9, far_place(r), impact(r)});
  });
  add("sine 1e-16..0.1", [=](R& r) {
    return aimed(r, {1, r.decades(0, 3), r.decades(0, 3), 10, place(r), impact(r), sine(r)});
  });
  add("sine 1e-16..0.1, length 1e3..1e9", [=](R& r) {
    return aimed(r, {1, r.decades(3, 9), r.decades(0, 6), 10, r.uniform(-0.1, 1.1), impact(r), sine(r)});
  });
  add("parallel to a coordinate axis", [=](R& r) {
    RodCase c;
    const Three a = plus3({0, 0, 0}, r.direction(), 10);
    const auto k = static_cast<std::size_t>(r.uniform(0, 3)), across = (k + 1) % 3, other = (k + 2) % 3;
    const double length = r.decades(0, 3) * r.sign(), along = r.sign(), turn = r.uniform(0, 6.3), off = impact(r);
    Three b = a;
    b[k] += length;
    c.rod = rod_between(a, b, 1);
    c.direction = {0, 0, 0};
    c.direction[k] = along;
    c.origin[k] = a[k] - along * (r.decades(0, 3) + std::abs(length) + 2);
    c.origin[across] = a[across] + off * std::cos(turn);
    c.origin[other] = a[other] + off * std::sin(turn);
    return c;
  });
  add("grazing the body to 1e-15", [=](R& r) {
    return aimed(r, {1, r.decades(0, 3), r.decades(0, 3), 10, r.uniform(0, 1), near(r, -15, -6)});
  });
  add("grazing the body, all to 1e6", [=](R& r) {
    return aimed(r, {1, r.decades(3, 6), r.decades(0, 6), 10, r.uniform(0, 1), near(r, -15, -6)});
  });
  add("grazing the ends to 1e-15", [=](R& r) {
    return aimed(r, {1, r.decades(0, 3), r.decades(0, 3), 10, r.sign() > 0 ? 0.0 : 1.0, near(r, -15, -6)});
  });
  add("where body and end join, to 1e-17",
      [=](R& r) { return at_seam(r, r.decades(-1, 3), r.sign() * r.decades(-17, -3), 1, r.decades(-1, 3), false); });
  add("grazing where they join", [=](R& r) {
    return at_seam(r, r.decades(-1, 6), r.sign() * r.decades(-17, -3), near(r, -15, -6), r.decades(0, 6), true);
  });
  add("the same, distance 1e6..1e12", [=](R& r) {
    return at_seam(r, r.decades(-1, 6), r.sign() * r.decades(-17, 0), near(r, -15, -6), r.decades(6, 12), r.sign() > 0);
  });
  add("direction 1e-20..1e20", [=](R& r) {
    RodCase c = aimed(r, {r.decades(-3, 3), r.decades(-1, 3), r.decades(0, 3), 10, place(r), impact(r)});
    c.direction = plus3({0, 0, 0}, c.direction, r.decades(-20, 20));
    return c;
  });
  add("just outside, to 1e-18", [=](R& r) { return leaving(r, 1, r.decades(-1, 2), 10, r.decades(-18, -1)); });
  add("just outside, offset 1e9", [=](R& r) { return leaving(r, 1, r.decades(-1, 2), 1e9, r.decades(-18, -1)); });
  add("just outside, length 1e3..1e9", [=](R& r) { return leaving(r, 1, r.decades(3, 9), 10, r.decades(-18, -1)); });
  add("just outside, nearly parallel", [=](R& r) {
    RodCase c = leaving(r, 1, r.decades(-1, 6), 10, r.decades(-18, -1));
    const Three u = unit3(c.axis());
    c.direction = plus3(plus3({0, 0, 0}, u, r.sign()), r.perpendicular(u), sine(r));
    return c;
  });
  add("inside", [=](R& r) {
    RodCase c = leaving(r, 1, r.decades(-1, 2), 10, 1e-3);
    c.origin = plus3(c.a(), r.direction(), 0.5);
    c.low = {0, 0, 0};
    return c;
  });
  add("leaving a larger sphere at an end", [=](R& r) { return leaving_atom(r, r.decades(-18, -1)); });
  add("grazing and nearly parallel", [=](R& r) {
    return aimed(r, {1, r.decades(0, 6), r.decades(0, 6), 10, place(r), near(r, -15, -6), sine(r)});
  });
  list.back().slides = true;
  add("everything", [=](R& r) {
    return aimed(r,
                 {r.decades(-12, 12), r.decades(-18, 9), r.decades(-1, 12), r.uniform(0, 1) < 0.3 ? 0 : r.decades(0, 9),
                  place(r), impact(r), r.sign() > 0 ? -1 : r.decades(-16, 0)});
  });
  add("radius 1e-30 and 1e18", [=](R& r) {
    if (r.sign() > 0)
      return aimed(r, {r.decades(-30, -25), r.decades(-3, 9), r.decades(0, 9), r.decades(0, 9), place(r), impact(r),
                       r.sign() > 0 ? -1 : r.decades(-16, 0)});
    const double radius = r.decades(12, 18), most = std::log10(1e18 / radius);
    return aimed(r, {radius, r.decades(-3, most), r.decades(0, most), 0, place(r), impact(r),
                     r.sign() > 0 ? -1 : r.decades(-16, 0)});
  });
  return list;
}

/// The reference solution, in multi-precision arithmetic.
template <class Real>
struct RodTruth {
  using Vec = Vec3Of<Real>;
  Vec origin, direction, a, axis;
  Real radius, length;  ///< `length`: of the direction
  bool hit = false;
  bool in_band = false;  ///< undecidable in double
  Real t = 0.0, place = 0.0, cosine = 0.0;
  Vec from_axis{0.0, 0.0, 0.0};

  explicit RodTruth(const RodCase& c)
      : origin(Vec{c.origin[0], c.origin[1], c.origin[2]} + Vec{c.low[0], c.low[1], c.low[2]}),
        direction{c.direction[0], c.direction[1], c.direction[2]},
        a{c.rod.a[0], c.rod.a[1], c.rod.a[2]},
        axis(Vec{c.rod.b[0], c.rod.b[1], c.rod.b[2]} - a),
        radius(c.rod.radius),
        length(sqrt(dot(direction, direction))) {
    solve();
  }

  /// The vector from the axis to a point.
  Vec off_axis(const Vec& point) const {
    const Vec f = point - a;
    const Real square = dot(axis, axis);
    Real s = Real(0.0) < square ? dot(f, axis) / square : Real(0.0);
    if (s < 0.0) s = 0.0;
    if (Real(1.0) < s) s = 1.0;
    return f - axis * s;
  }
  /// Distance from the surface, in radii; negative inside.
  double height(const Vec& point) const {
    const Vec m = off_axis(point);
    return (sqrt(dot(m, m)) / radius - 1.0).to_double();
  }

 private:
  static Vec cross(const Vec& p, const Vec& q) {
    return {p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
  }

  /// The entry into the sphere around a point of the axis; t is unchanged if the line misses it.
  void enter_sphere(const Real& s) {
    const Vec f = a + axis * s - origin;
    const Real square = length * length, middle = dot(f, direction) / square;
    const Vec l = f - direction * middle;
    Real rest = radius * radius - dot(l, l);
    if (rest < 0.0) rest = 0.0;
    place = s;
    t = middle - sqrt(rest / square);
    from_axis = direction * t - f;
  }

  void solve() {
    const Real square = length * length;
    const Vec f = a - origin, w = cross(direction, axis), p = cross(w, direction) * (Real(1.0) / square);
    const Real pp = dot(p, p), ww = dot(w, w), uu = dot(axis, axis), du = dot(direction, axis);
    Real s = Real(0.0) < pp ? Real(0.0) - dot(f, p) / pp : Real(0.0);
    if (s < 0.0) s = 0.0;
    if (Real(1.0) < s) s = 1.0;
    const Vec g = f + axis * s;
    const Real at = dot(g, direction) / square;
    const Vec l = g - direction * at;
    const Real passed = sqrt(dot(l, l));
    const bool line_hits = !(radius < passed);
    in_band = std::abs((passed / radius - 1.0).to_double()) < kUndecided || std::abs(height(origin)) < kUndecided;
    if (!line_hits) return;
    bool is_body = false;
    if (Real(0.0) < ww) {
      const Real height = dot(l, w);
      Real rest = radius * radius - height * height / ww;
      if (rest < 0.0) rest = 0.0;
      const Real ahead = dot(l, cross(axis, w)) / ww - sqrt(rest * uu / ww);
      const Real x = s + (ahead * du - dot(l, axis)) / uu;
      is_body = Real(0.0) < x && x < 1.0;
      if (is_body) {
        t = at + ahead;
        place = x;
        from_axis = origin + direction * t - (a + axis * x);
      } else {
        enter_sphere(x < 0.5 ? 0.0 : 1.0);
      }
    } else {
      enter_sphere(du < 0.0 ? 1.0 : 0.0);
    }
    hit = Real(0.0) < t;
    cosine = Real(0.0) - dot(from_axis, direction) / (sqrt(dot(from_axis, from_axis)) * length);
    if (cosine < 0.0) cosine = 0.0;
    in_band = in_band || std::abs((t * length * cosine / radius).to_double()) < kUndecided;
  }
};

struct RodTally {
  long rays = 0, hits = 0, wrong = 0, skipped = 0, differing = 0, doubtful = 0, filtered_hits = 0;
  double point = 0, distance = 0, surface = 0, normal = 0;
};

struct RodPackets {
  RodCase cases[kPacketSize];
  kernel::RayPacket<double> packet;
  Rod rods[kPacketSize];

  void set(int i, const RodCase& c) {
    cases[i] = c;
    rods[i] = c.rod;
    const double base[3] = {c.origin[0], c.origin[1], c.origin[2]}, low[3] = {c.low[0], c.low[1], c.low[2]},
                 direction[3] = {c.direction[0], c.direction[1], c.direction[2]};
    set_ray(packet, i, base, low, direction, kCamera);
  }
};

bool same_lane(const RodHits& a, const RodHits& b, int i) {
  if (a.hit[i] != b.hit[i]) return false;
  if (!a.hit[i]) return true;
  bool same = a.distance[i] == b.distance[i] && a.second_half[i] == b.second_half[i];
  for (int k = 0; k < 3; ++k)
    same = same && a.center[k][i] == b.center[k][i] && a.offset[k][i] == b.offset[k][i] &&
           a.outward[k][i] == b.outward[k][i];
  return same;
}

/// Adds the errors of a hit to the largest ones.
void add_errors(const RodTruth<QuadReal>& truth, const RodHits& found, int i, RodTally& tally) {
  using Vec = RodTruth<QuadReal>::Vec;
  const double cosine = truth.cosine.to_double();
  const auto row = [&](const double(&v)[3][kPacketSize]) { return Vec{v[0][i], v[1][i], v[2][i]}; };
  const Vec point = row(found.start) + row(found.start_low);
  const auto error = [&](const Vec& difference, const QuadReal& unit) {
    return (sqrt(dot(difference, difference)) / unit).to_double() * cosine;
  };
  const QuadReal inverse = QuadReal(1.0) / truth.radius;
  tally.point =
      std::max(tally.point, error(point - (truth.a + truth.axis * truth.place + truth.from_axis), truth.radius));
  tally.surface = std::max(tally.surface, std::abs(truth.height(point)));
  tally.normal = std::max(tally.normal, error(row(found.outward) - truth.from_axis * inverse, 1.0));
  const QuadReal t = truth.t * truth.length, scale = t < truth.radius ? truth.radius : t;
  const double off = ((QuadReal(found.distance[i]) - truth.t) * truth.length / scale).to_double();
  tally.distance = std::max(tally.distance, std::abs(off) * cosine);
}

RodTally run_regime(const RodRegime& regime, int rays) {
  RodRandom random;
  RodTally tally;
  for (int done = 0; done < rays; done += kPacketSize) {
    RodPackets p;
    for (int i = 0; i < kPacketSize; ++i) p.set(i, regime.make(random));
    const RodHits found = intersect_rods(test::Lanes::kAll, p.packet, p.rods);
    const RodHits one = intersect_rods(test::Lanes::kOne, p.packet, p.rods);
    for (int i = 0; i < kPacketSize; ++i) {
      ++tally.rays;
      tally.differing += !same_lane(found, one, i);
      const RodTruth<QuadReal> truth(p.cases[i]);
      if (tally.rays % 64 == 0) {  // checks the 113-bit reference against 320 bits
        const RodTruth<BigReal> more(p.cases[i]);
        tally.doubtful += more.hit != truth.hit && !truth.in_band;
        if (more.hit && !truth.in_band)
          tally.doubtful += std::abs(more.height(more.origin + more.direction * more.t)) > 1e-30 ||
                            std::abs(truth.height(truth.origin + truth.direction * truth.t)) > 1e-20;
      }
      tally.hits += truth.hit;
      tally.filtered_hits += (truth.hit || found.hit[i]) && !found.may_hit[i];
      if (truth.hit != found.hit[i]) {
        ++(truth.in_band ? tally.skipped : tally.wrong);
      } else if (truth.hit) {
        add_errors(truth, found, i, tally);
      }
    }
  }
  return tally;
}

void expect_exact_rods(int rays) {
  std::printf("%-38s %9s %9s %8s %6s %12s %14s %12s %12s\n", ("regime, " + kernel::isa_name()).c_str(), "rays", "hits",
              "in band", "wrong", "point x cos", "distance x cos", "off surface", "normal x cos");
  for (const RodRegime& regime : rod_regimes()) {
    const RodTally t = run_regime(regime, rays);
    std::printf("%-38s %9ld %9ld %8ld %6ld %12.1e %14.1e %12.1e %12.1e\n", regime.name.c_str(), t.rays, t.hits,
                t.skipped, t.wrong, t.point, t.distance, t.surface, t.normal);
    EXPECT_EQ(t.wrong, 0) << regime.name;
    EXPECT_EQ(t.doubtful, 0) << regime.name << ": 113 and 320 bits differ";
    EXPECT_EQ(t.differing, 0) << regime.name << ": one lane and all lanes differ";
    EXPECT_EQ(t.filtered_hits, 0) << regime.name << ": the conservative test rejects hits";
    if (!regime.slides) {
      EXPECT_LE(t.point, kRodPointBound) << regime.name;
      EXPECT_LE(t.distance, kRodDistanceBound) << regime.name;
    }
    EXPECT_LE(t.surface, kRodSurfaceBound) << regime.name;
    EXPECT_LE(t.normal, kRodNormalBound) << regime.name;
    EXPECT_LT(t.skipped, t.rays / 20) << regime.name;
  }
}

TEST(Rods, HitOrMissAndHitPointError) { expect_exact_rods(rods_per_regime(8000)); }

TEST(Rods, EveryInstructionSetIsAsExact) {
  for (const std::string& isa : kernel::available_isas()) {
    if (isa == kernel::available_isas().front()) continue;
    ASSERT_TRUE(kernel::limit_isa(isa));
    expect_exact_rods(rods_per_regime(8000) / 4);
  }
  kernel::limit_isa("");
}

/// Instruction sets with fused multiply-add.
TEST(Rods, InstructionSetsGiveTheSameBits) {
  const std::vector<std::string> isas = kernel::available_isas();
  long compared = 0;
  for (const RodRegime& regime : rod_regimes()) {
    RodRandom random;
    for (int done = 0; done < 1600; done += kPacketSize) {
      RodPackets p;
      for (int i = 0; i < kPacketSize; ++i) p.set(i, regime.make(random));
      const RodHits best = intersect_rods(test::Lanes::kAll, p.packet, p.rods);
      for (const std::string& isa : isas) {
        if (isa == isas.front() || isa == "sse4") continue;
        ASSERT_TRUE(kernel::limit_isa(isa));
        const RodHits other = intersect_rods(test::Lanes::kAll, p.packet, p.rods);
        for (int i = 0; i < kPacketSize; ++i) ASSERT_TRUE(same_lane(best, other, i)) << regime.name << ", " << isa;
        compared += kPacketSize;
      }
      kernel::limit_isa("");
    }
  }
  if (compared == 0) GTEST_SKIP() << "this processor has one instruction set with fused multiply-add";
}

/// Scaling a scene by a power of two scales the result, and changes no other bit.
TEST(Rods, PowersOfTwoScaleExactly) {
  for (const RodRegime& regime : rod_regimes()) {
    if (regime.name == "radius 1e-30 and 1e18" || regime.name == "direction 1e-20..1e20") continue;
    RodRandom random;
    for (int done = 0; done < 1600; done += kPacketSize) {
      RodPackets plain, scaled;
      const double scale = std::ldexp(1.0, static_cast<int>(random.uniform(-60, 48)));
      for (int i = 0; i < kPacketSize; ++i) {
        RodCase c = regime.make(random);
        plain.set(i, c);
        for (std::size_t k = 0; k < 3; ++k) {
          c.rod.a[k] *= scale;
          c.rod.b[k] *= scale;
          c.origin[k] *= scale;
          c.low[k] *= scale;
        }
        c.rod.radius *= scale;
        scaled.set(i, c);
      }
      const RodHits a = intersect_rods(test::Lanes::kAll, plain.packet, plain.rods);
      const RodHits b = intersect_rods(test::Lanes::kAll, scaled.packet, scaled.rods);
      for (int i = 0; i < kPacketSize; ++i) {
        ASSERT_EQ(a.hit[i], b.hit[i]) << regime.name;
        if (!a.hit[i]) continue;
        ASSERT_EQ(a.distance[i] * scale, b.distance[i]) << regime.name;
        for (int k = 0; k < 3; ++k) ASSERT_EQ(a.start[k][i] * scale, b.start[k][i]) << regime.name;
      }
    }
  }
}

/// Where a rod has length 0, and where a ray enters through an end, the hit is that of the sphere there, bit for bit.
TEST(Rods, EndsAreSpheres) {
  long at_ends = 0;
  for (const RodRegime& regime : rod_regimes()) {
    const bool is_sphere = regime.name.starts_with("length 0");
    RodRandom random;
    for (int done = 0; done < 1600; done += kPacketSize) {
      RodPackets p;
      for (int i = 0; i < kPacketSize; ++i) p.set(i, regime.make(random));
      const RodHits rods = intersect_rods(test::Lanes::kAll, p.packet, p.rods);
      kernel::Sphere spheres[kPacketSize];
      const std::uint64_t ids[kPacketSize] = {};
      for (int i = 0; i < kPacketSize; ++i) {
        const double* const end = rods.second_half[i] ? p.rods[i].b : p.rods[i].a;
        spheres[i] = {end[0], end[1], end[2], p.rods[i].radius};
      }
      const Intersections found = intersect_batch(kernel::Precision::kExact, test::Lanes::kAll, p.packet, spheres, ids);
      for (int i = 0; i < kPacketSize; ++i) {
        ASSERT_TRUE(!is_sphere || rods.hit[i] == found.hit[i]) << regime.name;
        if (!rods.hit[i] || !rods.at_end[i]) continue;
        ++at_ends;
        ASSERT_EQ(rods.distance[i], found.distance[i]) << regime.name;
        for (int k = 0; k < 3; ++k) ASSERT_EQ(rods.offset[k][i], found.offset[k][i]) << regime.name;
      }
    }
  }
  EXPECT_GT(at_ends, 5000);
}

/// Share of the lines through a ball of radius 4, uniform and isotropic, that hit a convex body: the ratio of surfaces.
///
/// Reference  Cauchy's surface formula
TEST(Rods, ShareOfLinesThatHit) {
  RodRandom random;
  constexpr double kBall = 4, kLength = 3, kRadius = 0.5;
  const int rays = rods_per_regime(200000) / kPacketSize * kPacketSize;
  long hits = 0;
  for (int done = 0; done < rays; done += kPacketSize) {
    RodPackets p;
    for (int i = 0; i < kPacketSize; ++i) {
      RodCase c;
      const Three u = random.direction();
      c.rod = rod_between(plus3({0, 0, 0}, u, -kLength / 2), plus3({0, 0, 0}, u, kLength / 2), kRadius);
      c.direction = random.direction();
      const double off = kBall * std::sqrt(random.uniform(0, 1));
      c.origin = plus3(plus3({0, 0, 0}, random.perpendicular(c.direction), off), c.direction, -10);
      p.set(i, c);
    }
    const RodHits found = intersect_rods(test::Lanes::kAll, p.packet, p.rods);
    for (const bool hit : found.hit) hits += hit;
  }
  const double share = (2 * kRadius * kLength + 4 * kRadius * kRadius) / (4 * kBall * kBall);
  const double sigma = std::sqrt(share * (1 - share) / rays);
  const double z = (static_cast<double>(hits) / rays - share) / sigma;
  std::printf("share of lines that hit: %.5f, expected %.5f, z = %.2f\n", static_cast<double>(hits) / rays, share, z);
  EXPECT_LT(std::abs(z), 4);
}

/// Rays whose distance has a closed form: perpendicular to the axis, and parallel to it.
TEST(Rods, ClosedForms) {
  RodPackets p;
  const Rod rod = rod_between({-2, 0, 0}, {2, 0, 0}, 1);
  for (int i = 0; i < kPacketSize; ++i) {
    const double off = i / 16.0;  // squares are exact
    RodCase c;
    c.rod = rod;
    c.direction = {0, 0, -1};
    c.origin = {1 - i / 8.0, off, 8};
    p.set(i, c);
  }
  const RodHits across = intersect_rods(test::Lanes::kAll, p.packet, p.rods);
  for (int i = 0; i < kPacketSize; ++i) {
    const double off = i / 16.0;
    ASSERT_TRUE(across.hit[i]);
    EXPECT_NEAR(across.distance[i], 8 - std::sqrt(1 - off * off), 1e-15 * 8);
    EXPECT_EQ(across.second_half[i], 1 - i / 8.0 > 0);
  }
  for (int i = 0; i < kPacketSize; ++i) {
    RodCase c;
    c.rod = rod;
    c.direction = {i % 2 == 0 ? -1.0 : 1.0, 0, 0};
    c.origin = {-8 * c.direction[0], 0, i / 16.0};
    p.set(i, c);
  }
  const RodHits parallel = intersect_rods(test::Lanes::kAll, p.packet, p.rods);
  for (int i = 0; i < kPacketSize; ++i) {
    const double off = i / 16.0;
    ASSERT_TRUE(parallel.hit[i]);
    EXPECT_NEAR(parallel.distance[i], 6 - std::sqrt(1 - off * off), 1e-15 * 8);
    EXPECT_EQ(parallel.second_half[i], i % 2 == 0);
  }
}

/// In `fast`, errors are those of single precision from the smallest radius on, and the conservative test rejects no
/// hit.
TEST(Rods, FastRodsAreAsAccurateAsSinglePrecision) {
  RodRandom random;
  long hits = 0, wrong = 0;
  double worst = 0;
  const int rays = rods_per_regime(40000);
  for (int done = 0; done < rays; done += kPacketSize) {
    RodPackets p;
    for (int i = 0; i < kPacketSize; ++i) {
      RodCase c = aimed(random, {random.decades(-16, 9), random.decades(-3, 2), random.decades(0, 1.5), 3,
                                 random.uniform(-0.3, 1.3), random.uniform(0, 1.1)});
      for (std::size_t k = 0; k < 3; ++k) {
        c.rod.a[k] = static_cast<float>(c.rod.a[k]);
        c.rod.b[k] = static_cast<float>(c.rod.b[k]);
        c.origin[k] = static_cast<float>(c.origin[k]);
        c.direction[k] = static_cast<float>(c.direction[k]);
      }
      c.rod.radius = static_cast<float>(c.rod.radius);
      p.set(i, c);
    }
    const RodHits found = intersect_rods_fast(test::Lanes::kAll, p.packet, p.rods);
    const RodHits one = intersect_rods_fast(test::Lanes::kOne, p.packet, p.rods);
    for (int i = 0; i < kPacketSize; ++i) {
      ASSERT_TRUE(same_lane(found, one, i));
      const RodTruth<QuadReal> truth(p.cases[i]);
      ASSERT_TRUE(found.may_hit[i] || !truth.hit);
      hits += truth.hit;
      wrong += truth.hit != found.hit[i];
      if (!truth.hit || !found.hit[i]) continue;
      const double scale = std::max((truth.t * truth.length / truth.radius).to_double(), 1.0);
      const double error = ((QuadReal(found.distance[i]) - truth.t) * truth.length / truth.radius).to_double();
      worst = std::max(worst, std::abs(error) * truth.cosine.to_double() / scale);
    }
  }
  std::printf("fast: %ld hits, %ld wrong, distance x cos %.1e\n", hits, wrong, worst);
  EXPECT_LT(static_cast<double>(wrong), 1e-3 * rays);
  EXPECT_LT(worst, 2e-5);
}

}  // namespace
}  // namespace orrery::test
