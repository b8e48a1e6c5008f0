// SPDX-License-Identifier: Apache-2.0
#include "support/intersect_batch.h"

#include <hwy/highway.h>

#include "kernel/intersect-inl.h"
#include "math/dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::test::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
namespace k = kernel::HWY_NAMESPACE;

template <class D, kernel::Precision kPrecision>
void run(const kernel::RayPacket<double>& packet, const kernel::Sphere* spheres, const std::uint64_t* ids,
         Intersections& out) {
  const D d;
  const k::IdTag<D> du;
  for (int v = 0; v < kernel::kPacketSize; v += static_cast<int>(hn::Lanes(d))) {
    alignas(64) double s[4][kernel::kPacketSize];
    for (int i = 0; i < kernel::kPacketSize; ++i) {
      s[0][i] = spheres[i].x;
      s[1][i] = spheres[i].y;
      s[2][i] = spheres[i].z;
      s[3][i] = spheres[i].radius;
    }
    const auto ray = k::load_rays(d, packet, v);
    const k::Spheres<D> sphere{k::load3(d, s[0] + v, s[1] + v, s[2] + v), hn::Load(d, s[3] + v)};
    const auto is_self = hn::RebindMask(d, hn::LoadU(du, ids + v) == ray.self);
    const auto found = k::closest_distance<D, kPrecision>(d, ray, sphere, is_self);
    const auto offset = k::hit_point<D, kPrecision>(ray, sphere, is_self, found.value).offset;
    alignas(64) double hit[kernel::kPacketSize];
    hn::Store(hn::IfThenElseZero(found.mask, hn::Set(d, 1.0)), d, hit + v);
    hn::StoreU(found.value, d, out.distance + v);
    hn::StoreU(offset.x, d, out.offset[0] + v);
    hn::StoreU(offset.y, d, out.offset[1] + v);
    hn::StoreU(offset.z, d, out.offset[2] + v);
    for (std::size_t i = 0; i < hn::Lanes(d); ++i)
      out.hit[static_cast<std::size_t>(v) + i] = hit[static_cast<std::size_t>(v) + i] != 0;
  }
}

using One = hn::FixedTag<double, 1>;
using All = hn::ScalableTag<double>;

void exact_one(const kernel::RayPacket<double>& p, const kernel::Sphere* s, const std::uint64_t* i, Intersections& o) {
  run<One, kernel::Precision::kExact>(p, s, i, o);
}
void exact_all(const kernel::RayPacket<double>& p, const kernel::Sphere* s, const std::uint64_t* i, Intersections& o) {
  run<All, kernel::Precision::kExact>(p, s, i, o);
}
void book_all(const kernel::RayPacket<double>& p, const kernel::Sphere* s, const std::uint64_t* i, Intersections& o) {
  run<All, kernel::Precision::kBook>(p, s, i, o);
}

void set_lane(kernel::RayPacket<double>& p, int lane, const double* base, const double* offset, const double* direction,
              std::uint64_t self) {
  const One d;
  const auto b = k::set3(d, base), o = k::set3(d, offset), w = k::set3(d, direction);
  const auto origin = b + o;
  const auto low = k::sum_error(b, o, origin);
  const auto store = [&](const auto& v, auto& to) {
    to[0][lane] = hn::GetLane(v.x);
    to[1][lane] = hn::GetLane(v.y);
    to[2][lane] = hn::GetLane(v.z);
  };
  store(origin, p.origin);
  store(low, p.origin_low);
  store(o, p.offset);
  store(w, p.direction);
  p.inverse_square[lane] = hn::GetLane(hn::Set(d, 1.0) / k::dot(w, w));
  p.self[lane] = self;
}

}  // namespace orrery::test::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#ifndef ORRERY_OTHER_SET
namespace orrery::test {

using IntersectSpheres = void(const kernel::RayPacket<double>& packet, const kernel::Sphere* spheres,
                              const std::uint64_t* ids, Intersections& out);
ORRERY_DECLARE_INSTANCES(IntersectSpheres exact_one, exact_all, book_all;
                         void set_lane(kernel::RayPacket<double>& packet, int lane, const double* base,
                                       const double* offset, const double* direction, std::uint64_t self);)

Intersections intersect_batch(kernel::Precision precision, test::Lanes lanes, const kernel::RayPacket<double>& packet,
                              const kernel::Sphere* spheres, const std::uint64_t* ids) {
  Intersections out;
  if (precision == kernel::Precision::kBook) {
    ORRERY_BEST_INSTANCE(book_all)(packet, spheres, ids, out);
  } else if (lanes == test::Lanes::kOne) {
    ORRERY_BEST_INSTANCE(exact_one)(packet, spheres, ids, out);
  } else {
    ORRERY_BEST_INSTANCE(exact_all)(packet, spheres, ids, out);
  }
  return out;
}

void set_ray(kernel::RayPacket<double>& packet, int lane, const double (&base)[3], const double (&offset)[3],
             const double (&direction)[3], std::uint64_t self) {
  ORRERY_BEST_INSTANCE(set_lane)(packet, lane, base, offset, direction, self);
}

}  // namespace orrery::test
#endif
