// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdint>

#include "accel/embree_scene.h"
#include "accel/list.h"
#include "math/dispatch.h"

namespace orrery::accel {
namespace {

TEST(AccelInstances, FunctionsAreThoseOfTheChosenSetAndPrecision) {
  using kernel::Precision;
  const std::int64_t all = math::target_choice().available();
  for (std::int64_t set = all & -all; set != 0 && set <= all; set <<= 1) {
    if ((all & set) == 0) continue;
    math::target_choice().limit(set);
    const EmbreeFunctions exact = embree_functions(Precision::kExact), fast = embree_functions(Precision::kFast);
    EXPECT_EQ(exact.tracer.target, set);
    EXPECT_EQ(fast.tracer.target, set);
    EXPECT_NE(exact.tracer.trace, fast.tracer.trace);
    EXPECT_NE(exact.spheres.intersect, fast.spheres.intersect);
    for (const Precision precision : {Precision::kExact, Precision::kFast, Precision::kBook})
      EXPECT_EQ(list_tracer(precision).target, set);
    EXPECT_NE(list_tracer(Precision::kExact).trace, list_tracer(Precision::kBook).trace);
  }
  math::target_choice().limit(all);
}

}  // namespace
}  // namespace orrery::accel
