// SPDX-License-Identifier: Apache-2.0
// Embree's API: the differences between versions 3.13 (Debian 12) and 4 (Debian 13), and a scene with its device.
#pragma once

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>

namespace orrery::accel {

/// Embree's function for these rays: closest hits of an RTCRayHit, RTCRayHit4, 8 or 16, occlusion of an RTCRay etc.
template <class Rays>
constexpr auto query_function() {
  if constexpr (std::is_same_v<Rays, RTCRayHit16>) return rtcIntersect16;
  if constexpr (std::is_same_v<Rays, RTCRayHit8>) return rtcIntersect8;
  if constexpr (std::is_same_v<Rays, RTCRayHit4>) return rtcIntersect4;
  if constexpr (std::is_same_v<Rays, RTCRayHit>) return rtcIntersect1;
  if constexpr (std::is_same_v<Rays, RTCRay16>) return rtcOccluded16;
  if constexpr (std::is_same_v<Rays, RTCRay8>) return rtcOccluded8;
  if constexpr (std::is_same_v<Rays, RTCRay4>) return rtcOccluded4;
  if constexpr (std::is_same_v<Rays, RTCRay>) return rtcOccluded1;
}

#if RTC_VERSION_MAJOR >= 4

using EmbreeContext = RTCRayQueryContext;

inline void init(EmbreeContext& context) { rtcInitRayQueryContext(&context); }
inline void init(RTCIntersectArguments& arguments) { rtcInitIntersectArguments(&arguments); }
inline void init(RTCOccludedArguments& arguments) { rtcInitOccludedArguments(&arguments); }

/// Arguments of a query of closest hits, or of occlusion.
template <class Rays>
struct QueryArguments {
  static constexpr bool kHasHits = requires(Rays rays) { rays.hit; };
  std::conditional_t<kHasHits, RTCIntersectArguments, RTCOccludedArguments> arguments;

  explicit QueryArguments(EmbreeContext& context) {
    init(arguments);
    arguments.context = &context;
  }
};

/// Traces a packet, or tests it for occlusion.
template <class Rays>
inline void query(const int* valid, RTCScene scene, EmbreeContext& context, Rays& rays) {
  QueryArguments<Rays> how(context);
  query_function<Rays>()(valid, scene, &rays, &how.arguments);
}

/// Traces a single ray, or tests it for occlusion.
template <class Ray>
inline void query(RTCScene scene, EmbreeContext& context, Ray& ray) {
  QueryArguments<Ray> how(context);
  query_function<Ray>()(scene, &ray, &how.arguments);
}

#else

using EmbreeContext = RTCIntersectContext;

inline void init(EmbreeContext& context) { rtcInitIntersectContext(&context); }

template <class Rays>
inline void query(const int* valid, RTCScene scene, EmbreeContext& context, Rays& rays) {
  query_function<Rays>()(valid, scene, &context, &rays);
}

template <class Ray>
inline void query(RTCScene scene, EmbreeContext& context, Ray& ray) {
  query_function<Ray>()(scene, &context, &ray);
}

#endif

/// An Embree scene with its own device and a count of its memory.
class OwnedScene {
 public:
  /// `settings` configure Embree's device, e.g. "threads=1". Limits Embree to the instruction set kernel::isa_name().
  ///
  /// Errors     base::Error if Embree does not start: kNoMemory, kInternal with Embree's code
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
  /// Errors     base::Error: kStopped if a progress monitor cancelled the build, kNoMemory, kInternal with Embree's
  /// code
  void commit();

 private:
  std::atomic<std::int64_t> bytes_{0};  // declared first: Embree updates it until the last release
  RTCDevice device_ = nullptr;
  RTCScene scene_ = nullptr;
};

}  // namespace orrery::accel
