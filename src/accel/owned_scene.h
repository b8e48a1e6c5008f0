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

/// An Embree scene with its own device and a count of its memory.
class OwnedScene {
 public:
  /// `settings` configure Embree's device, e.g. "threads=1". Limits Embree to the instruction set kernel::isa_name().
  ///
  /// Errors     base::Error(kInternal) if Embree does not start
  explicit OwnedScene(std::string settings = {});
  ~OwnedScene();
  OwnedScene(const OwnedScene&) = delete;
  OwnedScene& operator=(const OwnedScene&) = delete;

  RTCDevice device() const noexcept { return device_; }
  RTCScene get() const noexcept { return scene_; }
  std::size_t bytes() const noexcept;

  /// The version of the Embree library that was loaded, e.g. "3.13.5".
  std::string version() const;

  /// Whether Embree hands packets of 4, 8 or 16 rays to callbacks as they are.
  bool has_packets_of(int width) const noexcept;

  /// Commits a geometry and transfers it to the scene.
  void attach(RTCGeometry geometry);

  /// Builds the BVH.
  ///
  /// Errors     base::Error(kInternal) with Embree's code, kStopped if a progress monitor cancelled the build
  void commit();

 private:
  std::atomic<std::int64_t> bytes_{0};  // declared first: Embree updates it until the last release
  RTCDevice device_ = nullptr;
  RTCScene scene_ = nullptr;
};

/// Builds a scene of Embree's built-in sphere points, rounded to float; radii are not padded.
///
/// Errors     base::Error(kInternal) if Embree fails
void build_sphere_points(OwnedScene& scene, std::size_t count,
                         const std::function<kernel::Sphere(std::size_t i)>& sphere_at);

}  // namespace orrery::accel
