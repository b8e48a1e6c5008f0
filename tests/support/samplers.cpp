// SPDX-License-Identifier: Apache-2.0
#include "support/samplers.h"

#include "kernel/camera-inl.h"
#include "kernel/intersect-inl.h"
#include "kernel/scatter-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::test::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
namespace k = kernel::HWY_NAMESPACE;

using D = hn::ScalableTag<double>;

k::Vec3<hn::Vec<D>> sample(D d, Shape shape, const k::Four<hn::Vec<D>>& u) {
  k::Surface<D> at;
  at.normal = at.offset = k::set3(d, kNormal);
  at.direction = k::negated(at.normal);
  at.from_outside = hn::FirstN(d, hn::Lanes(d));
  switch (shape) {
    case Shape::kLambertian: return k::sample_lambertian(at, k::sample_unit_sphere(d, u.v[0], u.v[1]));
    case Shape::kHemisphere: return k::sample_hemisphere(at, k::sample_unit_sphere(d, u.v[0], u.v[1]));
    case Shape::kFuzzyMetal:
      at.fuzz = hn::Set(d, kFuzz);
      return k::sample_metal(at, k::sample_unit_sphere(d, u.v[0], u.v[1])).direction;
    case Shape::kDisc: {
      const auto p = k::sample_unit_disc(d, u.v[2], u.v[3]);
      return {p.x, p.y, hn::Zero(d)};
    }
    case Shape::kPixel: break;
  }
  return {u.v[0], u.v[1], hn::Zero(d)};
}

void draw_all(Shape shape, std::uint32_t first, std::size_t count, double* x, double* y, double* z) {
  const D d;
  const k::IdTag<D> du;
  // As in an image: neighbouring pixels with some hundred samples each.
  constexpr std::uint32_t kSamplesPerPixel = 256;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const std::uint32_t index = first + static_cast<std::uint32_t>(i);
    const auto name = hn::Add(hn::Iota(du, 0), hn::Set(du, index));
    const auto random = k::random_at_vertex(d, {kernel::SamplerKind::kIndependent, 7}, hn::ShiftRight<8>(name),
                                            hn::And(name, hn::Set(du, kSamplesPerPixel - 1)), 1, true);
    const auto p = sample(d, shape, random);
    hn::StoreU(p.x, d, x + i);
    hn::StoreU(p.y, d, y + i);
    hn::StoreU(p.z, d, z + i);
  }
}

}  // namespace orrery::test::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace orrery::test {

void draw(Shape shape, std::uint32_t first, std::size_t count, double* x, double* y, double* z) {
  HWY_NAMESPACE::draw_all(shape, first, count, x, y, z);
}

}  // namespace orrery::test
