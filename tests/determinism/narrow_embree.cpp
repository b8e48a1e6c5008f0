// SPDX-License-Identifier: Apache-2.0
// Preloaded into the program: opens Embree with the settings in $ORRERY_TEST_EMBREE, like an Embree that was built for
// fewer instruction sets than the processor has.
#include <dlfcn.h>

#include <cstdlib>
#include <string>

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

RTC_API RTCDevice rtcNewDevice(const char* settings) {
  const auto embrees = reinterpret_cast<RTCDevice (*)(const char*)>(dlsym(RTLD_NEXT, "rtcNewDevice"));
  const std::string with = std::string(settings) + (*settings != '\0' ? "," : "") + std::getenv("ORRERY_TEST_EMBREE");
  return embrees(with.c_str());
}
