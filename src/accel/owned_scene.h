// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

#include "accel/embree_compat.h"
#include "kernel/sphere.h"

namespace orrery::accel {

/// An Embree scene with a device of its own, and the count of its bytes.
class OwnedScene {
 public:
  /// `settings` of Embree, such as "threads=1"; it uses no better instruction set than kernel::isa_name().
  ///
  /// Errors     base::Error(kInternal) if Embree does not start
  explicit OwnedScene(std::string settings = {});
  ~OwnedScene();
  OwnedScene(const OwnedScene&) = delete;
  OwnedScene& operator=(const OwnedScene&) = delete;

  RTCDevice device() const noexcept { return device_; }
  RTCScene get() const noexcept { return scene_; }
  std::size_t bytes() const noexcept;

  /// Hands a finished geometry to the scene, which then owns it.
  void attach(RTCGeometry geometry);

  /// Builds the hierarchy.
  ///
  /// Errors     base::Error(kInternal) with Embree's code, kStopped where a progress monitor said so
  void commit();

 private:
  std::atomic<std::int64_t> bytes_{0};  // Embree counts until the last release
  RTCDevice device_ = nullptr;
  RTCScene scene_ = nullptr;
};

/// Builds a scene of Embree's own sphere points, rounded to floats. Radii are taken as they are.
///
/// Errors     base::Error(kInternal) where Embree fails
void build_sphere_points(OwnedScene& scene, std::size_t count,
                         const std::function<kernel::Sphere(std::size_t i)>& sphere_at);

}  // namespace orrery::accel
