// SPDX-License-Identifier: Apache-2.0
// The API differences between Embree 3.13 (Debian 12) and 4 (Debian 13).
#pragma once

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace orrery::accel {

#if RTC_VERSION_MAJOR >= 4

using EmbreeContext = RTCRayQueryContext;

inline void init(EmbreeContext& context) { rtcInitRayQueryContext(&context); }

/// Traces a packet of 4, 8 or 16 rays, depending on the type of `rays`.
template <class Rays>
inline void intersect(const int* valid, RTCScene scene, EmbreeContext& context, Rays& rays) {
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &context;
  if constexpr (sizeof(Rays) == sizeof(RTCRayHit16)) {
    rtcIntersect16(valid, scene, &rays, &arguments);
  } else if constexpr (sizeof(Rays) == sizeof(RTCRayHit8)) {
    rtcIntersect8(valid, scene, &rays, &arguments);
  } else {
    rtcIntersect4(valid, scene, &rays, &arguments);
  }
}

/// Traces one ray.
inline void intersect(RTCScene scene, EmbreeContext& context, RTCRayHit& ray) {
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &context;
  rtcIntersect1(scene, &ray, &arguments);
}

/// Tests a packet of 4, 8 or 16 rays, depending on the type of `rays`, for occlusion.
template <class Rays>
inline void occluded(const int* valid, RTCScene scene, EmbreeContext& context, Rays& rays) {
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.context = &context;
  if constexpr (sizeof(Rays) == sizeof(RTCRay16)) {
    rtcOccluded16(valid, scene, &rays, &arguments);
  } else if constexpr (sizeof(Rays) == sizeof(RTCRay8)) {
    rtcOccluded8(valid, scene, &rays, &arguments);
  } else {
    rtcOccluded4(valid, scene, &rays, &arguments);
  }
}

/// Tests one ray for occlusion.
inline void occluded(RTCScene scene, EmbreeContext& context, RTCRay& ray) {
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.context = &context;
  rtcOccluded1(scene, &ray, &arguments);
}

#else

using EmbreeContext = RTCIntersectContext;

inline void init(EmbreeContext& context) { rtcInitIntersectContext(&context); }

template <class Rays>
inline void intersect(const int* valid, RTCScene scene, EmbreeContext& context, Rays& rays) {
  if constexpr (sizeof(Rays) == sizeof(RTCRayHit16)) {
    rtcIntersect16(valid, scene, &context, &rays);
  } else if constexpr (sizeof(Rays) == sizeof(RTCRayHit8)) {
    rtcIntersect8(valid, scene, &context, &rays);
  } else {
    rtcIntersect4(valid, scene, &context, &rays);
  }
}

inline void intersect(RTCScene scene, EmbreeContext& context, RTCRayHit& ray) { rtcIntersect1(scene, &context, &ray); }

template <class Rays>
inline void occluded(const int* valid, RTCScene scene, EmbreeContext& context, Rays& rays) {
  if constexpr (sizeof(Rays) == sizeof(RTCRay16)) {
    rtcOccluded16(valid, scene, &context, &rays);
  } else if constexpr (sizeof(Rays) == sizeof(RTCRay8)) {
    rtcOccluded8(valid, scene, &context, &rays);
  } else {
    rtcOccluded4(valid, scene, &context, &rays);
  }
}

inline void occluded(RTCScene scene, EmbreeContext& context, RTCRay& ray) { rtcOccluded1(scene, &context, &ray); }

#endif

}  // namespace orrery::accel
