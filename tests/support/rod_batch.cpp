// SPDX-License-Identifier: Apache-2.0
#include "support/rod_batch.h"

#include <hwy/highway.h>

#include "kernel/rod-inl.h"
#include "math/dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::test::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
namespace k = kernel::HWY_NAMESPACE;

template <class D>
k::Vec3<hn::Vec<D>> load_as(D d, const double (&from)[3][kernel::kPacketSize], int first) {
  using T = hn::TFromD<D>;
  alignas(64) T row[3][kernel::kPacketSize];
  for (int axis = 0; axis < 3; ++axis)
    for (int i = 0; i < kernel::kPacketSize; ++i) row[axis][i] = static_cast<T>(from[axis][i]);
  return k::load3(d, row, first);
}

template <class D>
void store_as(D d, const k::Vec3<hn::Vec<D>>& v, double (&to)[3][kernel::kPacketSize], int first) {
  alignas(64) hn::TFromD<D> row[3][kernel::kPacketSize];
  k::store3(d, v, row, 0);
  for (int axis = 0; axis < 3; ++axis)
    for (int i = 0; i < static_cast<int>(hn::Lanes(d)); ++i) to[axis][first + i] = static_cast<double>(row[axis][i]);
}

template <class D>
void store_mask(D d, hn::Mask<D> mask, bool (&to)[kernel::kPacketSize], int first) {
  alignas(64) hn::TFromD<D> row[kernel::kPacketSize];
  hn::Store(hn::IfThenElseZero(mask, k::set(d, 1)), d, row);
  for (int i = 0; i < static_cast<int>(hn::Lanes(d)); ++i) to[first + i] = row[i] > 0;
}

template <class D, kernel::Precision kPrecision>
void run_rods(const kernel::RayPacket<double>& packet, const kernel::Rod* rods, RodHits& out) {
  const D d;
  using T = hn::TFromD<D>;
  double a[3][kernel::kPacketSize], b[3][kernel::kPacketSize];
  alignas(64) T radius[kernel::kPacketSize];
  for (int i = 0; i < kernel::kPacketSize; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      a[axis][i] = rods[i].a[axis];
      b[axis][i] = rods[i].b[axis];
    }
    radius[i] = static_cast<T>(rods[i].radius);
  }
  for (int v = 0; v < kernel::kPacketSize; v += static_cast<int>(hn::Lanes(d))) {
    k::Rays<D> ray{};
    ray.origin = load_as(d, packet.origin, v);
    ray.origin_low = load_as(d, packet.origin_low, v);
    ray.direction = load_as(d, packet.direction, v);
    ray.inverse_square = k::set(d, 1) / dot(ray.direction, ray.direction);
    const k::Rods<D> rod{load_as(d, a, v), load_as(d, b, v), hn::Load(d, radius + v)};
    const auto entry = k::closest_entry<D, kPrecision>(d, ray, rod);
    const auto at = k::rod_point<D, kPrecision>(d, ray, rod);
    const auto start = at.sphere.center + at.point.offset;
    store_mask(d, entry.hits, out.hit, v);
    store_mask(d, k::may_hit(ray, rod), out.may_hit, v);
    store_mask(d, entry.second_half, out.second_half, v);
    store_mask(d, entry.along == k::set(d, 0), out.at_end, v);
    store_as(d, at.sphere.center, out.center, v);
    store_as(d, at.point.offset, out.offset, v);
    store_as(d, at.point.outward, out.outward, v);
    store_as(d, start, out.start, v);
    store_as(d, k::sum_error(at.sphere.center, at.point.offset, start), out.start_low, v);
    alignas(64) T distance[kernel::kPacketSize];
    hn::Store(entry.distance, d, distance);
    for (int i = 0; i < static_cast<int>(hn::Lanes(d)); ++i) out.distance[v + i] = static_cast<double>(distance[i]);
  }
}

using enum kernel::Precision;

void rods_exact_one(const kernel::RayPacket<double>& p, const kernel::Rod* r, RodHits& o) {
  run_rods<hn::FixedTag<double, 1>, kExact>(p, r, o);
}
void rods_exact_all(const kernel::RayPacket<double>& p, const kernel::Rod* r, RodHits& o) {
  run_rods<hn::ScalableTag<double>, kExact>(p, r, o);
}
void rods_fast_one(const kernel::RayPacket<double>& p, const kernel::Rod* r, RodHits& o) {
  run_rods<hn::FixedTag<float, 1>, kFast>(p, r, o);
}
void rods_fast_all(const kernel::RayPacket<double>& p, const kernel::Rod* r, RodHits& o) {
  run_rods<hn::ScalableTag<float>, kFast>(p, r, o);
}

}  // namespace orrery::test::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#ifndef ORRERY_OTHER_SET
namespace orrery::test {

using IntersectRods = void(const kernel::RayPacket<double>& packet, const kernel::Rod* rods, RodHits& out);
ORRERY_DECLARE_INSTANCES(IntersectRods rods_exact_one, rods_exact_all, rods_fast_one, rods_fast_all)

RodHits intersect_rods(test::Lanes lanes, const kernel::RayPacket<double>& packet, const kernel::Rod* rods) {
  RodHits out{};
  if (lanes == test::Lanes::kOne) {
    ORRERY_BEST_INSTANCE(rods_exact_one)(packet, rods, out);
  } else {
    ORRERY_BEST_INSTANCE(rods_exact_all)(packet, rods, out);
  }
  return out;
}

RodHits intersect_rods_fast(test::Lanes lanes, const kernel::RayPacket<double>& packet, const kernel::Rod* rods) {
  RodHits out{};
  if (lanes == test::Lanes::kOne) {
    ORRERY_BEST_INSTANCE(rods_fast_one)(packet, rods, out);
  } else {
    ORRERY_BEST_INSTANCE(rods_fast_all)(packet, rods, out);
  }
  return out;
}

}  // namespace orrery::test
#endif
