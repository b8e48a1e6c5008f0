// SPDX-License-Identifier: Apache-2.0
#include "support/light_batch.h"

#include "kernel/light-inl.h"
#include "support/first_lane-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::test::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
namespace k = kernel::HWY_NAMESPACE;

using D = hn::ScalableTag<double>;
using V = hn::Vec<D>;

k::Vec3<V> all_lanes(D d, math::Vec3d v) { return {hn::Set(d, v.x), hn::Set(d, v.y), hn::Set(d, v.z)}; }

k::Vertex<D> vertex(D d, math::Vec3d point, math::Vec3d normal) {
  return {all_lanes(d, point), all_lanes(d, {0, 0, 0}), all_lanes(d, normal)};
}

VisiblePoint sample_point(math::Vec3d center, double radius, double u, double v) {
  const D d;
  const auto to = all_lanes(d, center);
  const auto cone = k::subtended_cone(to, hn::Set(d, radius));
  const auto sample = k::sample_visible_sphere(d, to, cone, hn::Set(d, u), hn::Set(d, v));
  return {first_lane(sample.direction), first_lane(sample.normal), hn::GetLane(k::solid_angle(cone.one_minus_cos))};
}

Choice choose(const kernel::SceneView& scene, math::Vec3d point, math::Vec3d normal, double u, double fresh) {
  const D d;
  const auto chosen = k::choose_light(d, scene, vertex(d, point, normal), hn::Set(d, u), hn::Set(d, fresh));
  return {static_cast<std::uint32_t>(hn::GetLane(chosen.spheres)), hn::GetLane(chosen.probability)};
}

double probability(const kernel::SceneView& scene, math::Vec3d point, math::Vec3d normal, std::uint32_t sphere) {
  const D d;
  return hn::GetLane(k::choice_probability(d, scene, vertex(d, point, normal), hn::Set(k::IdTag<D>(), sphere)));
}

}  // namespace orrery::test::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace orrery::test {

VisiblePoint visible_point(math::Vec3d center, double radius, double u, double v) {
  return HWY_NAMESPACE::sample_point(center, radius, u, v);
}
Choice choose_light(const kernel::SceneView& scene, math::Vec3d point, math::Vec3d normal, double u, double fresh) {
  return HWY_NAMESPACE::choose(scene, point, normal, u, fresh);
}
double choice_probability(const kernel::SceneView& scene, math::Vec3d point, math::Vec3d normal, std::uint32_t sphere) {
  return HWY_NAMESPACE::probability(scene, point, normal, sphere);
}

}  // namespace orrery::test
