// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <atomic>
#include <vector>

#include "accel/accel.h"
#include "base/error.h"
#include "kernel/scene_view.h"
#include "support/accel_rays.h"

namespace orrery::accel {
namespace {

using kernel::Sphere;
using test::Random;
using test::scattered;

TEST(AccelEmbree, BuildReportsProgressAndCanBeStopped) {
  Random random;
  const std::vector<Sphere> spheres = scattered(random, 200'000, 100, 0.1, 0);
  kernel::SceneView view;
  view.spheres = spheres.data();
  view.sphere_count = spheres.size();
  std::atomic<int> calls{0};
  std::atomic<bool> outside{false};
  make_embree(view, kernel::Precision::kExact, [&](double fraction) {
    ++calls;
    if (!(fraction >= 0 && fraction <= 1)) outside = true;
    return true;
  });
  EXPECT_GT(calls, 1);
  EXPECT_FALSE(outside);
  try {
    make_embree(view, kernel::Precision::kExact, [](double) { return false; });
    FAIL() << "the build was not stopped";
  } catch (const base::Error& error) {
    EXPECT_EQ(error.kind(), base::ErrorKind::kStopped);
  }
}

}  // namespace
}  // namespace orrery::accel
