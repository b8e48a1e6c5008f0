// SPDX-License-Identifier: Apache-2.0
#include "kernel/intersect_lanes.h"

#include "kernel/intersect-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::bench::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
namespace k = kernel::HWY_NAMESPACE;
using kernel::Precision;

template <class D, Precision kPrecision, class Packet>
HWY_INLINE void nearest_of_all(Packet& packet, const kernel::Sphere* spheres, std::size_t count) {
  const D d;
  const k::IdTag<D> du;
  using Id = hn::TFromD<k::IdTag<D>>;
  for (std::size_t i = 0; i < count; ++i) {
    const auto sphere = k::broadcast(d, spheres[i]);
    const auto id = hn::Set(du, static_cast<Id>(i));
    for (int v = 0; v < kernel::kPacketSize; v += static_cast<int>(hn::Lanes(d))) {
      const auto ray = k::load_rays(d, packet, v);
      const auto found = k::closest_distance<D, kPrecision>(d, ray, sphere, hn::RebindMask(d, ray.self == id));
      const auto best = hn::Load(d, packet.distance + v);
      const auto nearer = hn::And(found.mask, found.value < best);
      hn::Store(hn::IfThenElse(nearer, found.value, best), d, packet.distance + v);
      hn::Store(hn::IfThenElse(hn::RebindMask(du, nearer), id, hn::Load(du, packet.hit + v)), du, packet.hit + v);
    }
  }
}

template <class D, Precision kPrecision, class Packet, class T>
HWY_INLINE void all_hit_points(const Packet& packet, const SphereLanes<T>& spheres, PointLanes<T>& out) {
  const D d;
  const k::IdTag<D> du;
  for (int v = 0; v < kernel::kPacketSize; v += static_cast<int>(hn::Lanes(d))) {
    const auto ray = k::load_rays(d, packet, v);
    const k::Spheres<D> sphere{k::load3(d, spheres.center[0] + v, spheres.center[1] + v, spheres.center[2] + v),
                               hn::Load(d, spheres.radius + v)};
    const auto is_self = hn::RebindMask(d, hn::Load(du, packet.hit + v) == ray.self);
    const auto hit = k::hit_point<D, kPrecision>(ray, sphere, is_self, hn::Load(d, packet.distance + v));
    const auto store = [&](const auto& value, auto& to) {
      hn::Store(value.x, d, to[0] + v);
      hn::Store(value.y, d, to[1] + v);
      hn::Store(value.z, d, to[2] + v);
    };
    store(hit.offset, out.offset);
    store(hit.outward, out.outward);
  }
}

using One = hn::FixedTag<double, 1>;
using All = hn::ScalableTag<double>;
using OneFloat = hn::FixedTag<float, 1>;
using AllFloat = hn::ScalableTag<float>;
using kernel::RayPacket;
using kernel::Sphere;

void nearest_exact_one(RayPacket<double>& p, const Sphere* s, std::size_t n) {
  nearest_of_all<One, Precision::kExact>(p, s, n);
}
void nearest_exact_all(RayPacket<double>& p, const Sphere* s, std::size_t n) {
  nearest_of_all<All, Precision::kExact>(p, s, n);
}
void nearest_book_one(RayPacket<double>& p, const Sphere* s, std::size_t n) {
  nearest_of_all<One, Precision::kBook>(p, s, n);
}
void nearest_book_all(RayPacket<double>& p, const Sphere* s, std::size_t n) {
  nearest_of_all<All, Precision::kBook>(p, s, n);
}
void nearest_fast_one(RayPacket<float>& p, const Sphere* s, std::size_t n) {
  nearest_of_all<OneFloat, Precision::kFast>(p, s, n);
}
void nearest_fast_all(RayPacket<float>& p, const Sphere* s, std::size_t n) {
  nearest_of_all<AllFloat, Precision::kFast>(p, s, n);
}

void point_exact_one(const RayPacket<double>& p, const SphereLanes<double>& s, PointLanes<double>& o) {
  all_hit_points<One, Precision::kExact>(p, s, o);
}
void point_exact_all(const RayPacket<double>& p, const SphereLanes<double>& s, PointLanes<double>& o) {
  all_hit_points<All, Precision::kExact>(p, s, o);
}
void point_book_one(const RayPacket<double>& p, const SphereLanes<double>& s, PointLanes<double>& o) {
  all_hit_points<One, Precision::kBook>(p, s, o);
}
void point_book_all(const RayPacket<double>& p, const SphereLanes<double>& s, PointLanes<double>& o) {
  all_hit_points<All, Precision::kBook>(p, s, o);
}
void point_fast_one(const RayPacket<float>& p, const SphereLanes<float>& s, PointLanes<float>& o) {
  all_hit_points<OneFloat, Precision::kFast>(p, s, o);
}
void point_fast_all(const RayPacket<float>& p, const SphereLanes<float>& s, PointLanes<float>& o) {
  all_hit_points<AllFloat, Precision::kFast>(p, s, o);
}

}  // namespace orrery::bench::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace orrery::bench {

IntersectFunctions<double> intersect_double(kernel::Precision precision, test::Lanes lanes) {
  const bool one = lanes == test::Lanes::kOne;
  if (precision == kernel::Precision::kBook) {
    if (one) return {HWY_NAMESPACE::nearest_book_one, HWY_NAMESPACE::point_book_one};
    return {HWY_NAMESPACE::nearest_book_all, HWY_NAMESPACE::point_book_all};
  }
  if (one) return {HWY_NAMESPACE::nearest_exact_one, HWY_NAMESPACE::point_exact_one};
  return {HWY_NAMESPACE::nearest_exact_all, HWY_NAMESPACE::point_exact_all};
}

IntersectFunctions<float> intersect_float(test::Lanes lanes) {
  if (lanes == test::Lanes::kOne) return {HWY_NAMESPACE::nearest_fast_one, HWY_NAMESPACE::point_fast_one};
  return {HWY_NAMESPACE::nearest_fast_all, HWY_NAMESPACE::point_fast_all};
}

}  // namespace orrery::bench
