// SPDX-License-Identifier: Apache-2.0
#include "base/stop_point.h"

#include "base/error.h"

namespace orrery::base {
namespace {

thread_local const std::atomic<bool>* flag_of_thread = nullptr;

}  // namespace

StopScope::StopScope(const std::atomic<bool>* flag) noexcept : before_(flag_of_thread) { flag_of_thread = flag; }
StopScope::~StopScope() { flag_of_thread = before_; }

StopPoint::StopPoint() noexcept : flag_(flag_of_thread) {}
void StopPoint::fail() { throw Error(ErrorKind::kStopped, "stopped; nothing was written"); }

}  // namespace orrery::base
