// SPDX-License-Identifier: Apache-2.0
#include "accel/embree_api.h"

#include <gtest/gtest.h>

#include <string>

#include "base/error.h"
#include "support/sphere_points.h"

namespace orrery::accel {
namespace {

base::ErrorKind error_of(const auto& work) {
  try {
    work();
  } catch (const base::Error& error) {
    return error.kind();
  }
  ADD_FAILURE() << "no error";
  return base::ErrorKind::kInternal;
}

/// Embree then reports that it has no memory.
TEST(AccelEmbreeApi, MemoryThatIsRefusedIsAMemoryError) {
  OwnedScene scene;
  rtcSetDeviceMemoryMonitorFunction(
      scene.device(), [](void*, ssize_t bytes, bool) { return bytes <= 0; }, nullptr);
  EXPECT_EQ(error_of([&] {
              build_sphere_points(scene, 1000, [](std::size_t i) {
                return kernel::Sphere{static_cast<double>(i), 0, 0, 0.5};
              });
            }),
            base::ErrorKind::kNoMemory);
}

TEST(AccelEmbreeApi, OtherErrorsAreInternal) {
  OwnedScene scene;
  RTCGeometry geometry = rtcNewGeometry(scene.device(), RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryTimeStepCount(geometry, RTC_MAX_TIME_STEP_COUNT + 1);
  scene.attach(geometry);
  EXPECT_EQ(error_of([&] { scene.commit(); }), base::ErrorKind::kInternal);
}

}  // namespace
}  // namespace orrery::accel
