// SPDX-License-Identifier: Apache-2.0
#include "accel/embree_api.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "kernel/isa.h"

namespace orrery::accel {
namespace {

[[noreturn]] void fail(RTCError code, const std::string& what) {
  if (code == RTC_ERROR_CANCELLED) throw base::Error(base::ErrorKind::kStopped, "stopped while building");
  if (code == RTC_ERROR_OUT_OF_MEMORY)
    throw base::Error(base::ErrorKind::kNoMemory,
                      what + ": out of memory; orrery info SCENE prints how much a scene needs");
  throw base::Error(base::ErrorKind::kInternal,
                    what + " (Embree error " + std::to_string(static_cast<int>(code)) + ")");
}

/// Adds the instruction set limit, if there is one, to Embree's settings.
std::string with_isa_limit(std::string settings) {
  const std::vector<std::string> available = kernel::available_isas();
  const std::string isa = kernel::isa_name();
  if (available.empty() || isa == available.front()) return settings;
  if (!settings.empty()) settings += ',';
  return settings + "max_isa=" + (isa == "sse4" ? "sse4.2" : isa);
}

}  // namespace

OwnedScene::OwnedScene(std::string settings) : device_(rtcNewDevice(with_isa_limit(std::move(settings)).c_str())) {
  if (device_ == nullptr) fail(rtcGetDeviceError(nullptr), "Embree does not start");
  rtcSetDeviceMemoryMonitorFunction(
      device_,
      [](void* self, ssize_t bytes, bool) {
        static_cast<OwnedScene*>(self)->bytes_.fetch_add(bytes, std::memory_order_relaxed);
        return true;
      },
      this);
  scene_ = rtcNewScene(device_);
}

OwnedScene::~OwnedScene() {
  rtcReleaseScene(scene_);
  rtcReleaseDevice(device_);
}

std::size_t OwnedScene::bytes() const noexcept {
  return static_cast<std::size_t>(std::max<std::int64_t>(0, bytes_.load(std::memory_order_relaxed)));
}

std::string OwnedScene::version() const {
  const auto part = [&](RTCDeviceProperty property) { return std::to_string(rtcGetDeviceProperty(device_, property)); };
  return part(RTC_DEVICE_PROPERTY_VERSION_MAJOR) + '.' + part(RTC_DEVICE_PROPERTY_VERSION_MINOR) + '.' +
         part(RTC_DEVICE_PROPERTY_VERSION_PATCH);
}

bool OwnedScene::has_packets_of(int width) const noexcept {
  const RTCDeviceProperty property = width == 16  ? RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED
                                     : width == 8 ? RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED
                                                  : RTC_DEVICE_PROPERTY_NATIVE_RAY4_SUPPORTED;
  return rtcGetDeviceProperty(device_, property) != 0;
}

void OwnedScene::attach(RTCGeometry geometry) {
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene_, geometry);
  rtcReleaseGeometry(geometry);
}

void OwnedScene::commit() {
  rtcCommitScene(scene_);
  const RTCError error = rtcGetDeviceError(device_);
  if (error != RTC_ERROR_NONE) fail(error, "Embree cannot build the scene");
}

}  // namespace orrery::accel
