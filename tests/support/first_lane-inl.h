// SPDX-License-Identifier: Apache-2.0
// The result of a kernel function in its first lane. Compiled once per instruction set.
#pragma once

#include <hwy/highway.h>

#include "math/vec3-inl.h"
#include "math/vec3.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::test::HWY_NAMESPACE {

template <class V>
math::Vec3d first_lane(const math::HWY_NAMESPACE::Vec3<V>& v) {
  namespace hn = hwy::HWY_NAMESPACE;
  return {hn::GetLane(v.x), hn::GetLane(v.y), hn::GetLane(v.z)};
}

}  // namespace orrery::test::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
