// SPDX-License-Identifier: Apache-2.0
#include "support/caustic_batch.h"

#include "kernel/caustic_sampling-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::test::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
namespace k = kernel::HWY_NAMESPACE;

template <class D>
CausticDirection sampled(D d, const CausticPlace& place, int events, double u, double v, double choice) {
  using T = hn::TFromD<D>;
  const auto all = [&](double x) { return hn::Set(d, static_cast<T>(x)); };
  const auto all3 = [&](math::Vec3d x) { return k::Vec3<hn::Vec<D>>{all(x.x), all(x.y), all(x.z)}; };
  const double r0 = (place.eta - 1) / (place.eta + 1);
  const k::BallAndLight<D> from{all3(place.point),
                                all3(place.to_light),
                                all(place.inverse_distance),
                                all(place.light_sin),
                                all(place.eta),
                                all(r0 * r0),
                                all(place.inner > 0 ? place.inner : 1),
                                hn::FirstN(d, place.is_glass ? hn::Lanes(d) : 0),
                                hn::FirstN(d, place.inner > 0 ? hn::Lanes(d) : 0)};
  const auto sample = k::sample_caustic(d, from, events, hn::FirstN(d, hn::Lanes(d)), all(u), all(v), all(choice));
  const auto first = [](auto x) { return static_cast<double>(hn::GetLane(x)); };
  return {{first(sample.direction.x), first(sample.direction.y), first(sample.direction.z)},
          first(sample.inverse_pdf),
          static_cast<std::uint32_t>(hn::GetLane(sample.events))};
}

CausticDirection in_double(const CausticPlace& place, int events, double u, double v, double choice) {
  return sampled(hn::ScalableTag<double>(), place, events, u, v, choice);
}
CausticDirection in_float(const CausticPlace& place, int events, double u, double v, double choice) {
  return sampled(hn::ScalableTag<float>(), place, events, u, v, choice);
}

}  // namespace orrery::test::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace orrery::test {

CausticDirection caustic_direction(const CausticPlace& place, int events, double u, double v, double choice) {
  return HWY_NAMESPACE::in_double(place, events, u, v, choice);
}
CausticDirection caustic_direction_in_float(const CausticPlace& place, int events, double u, double v, double choice) {
  return HWY_NAMESPACE::in_float(place, events, u, v, choice);
}

}  // namespace orrery::test
