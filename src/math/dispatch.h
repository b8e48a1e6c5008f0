// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hwy/highway.h>

#include <cstdint>

namespace orrery::math {

/// The instruction sets (Highway's targets) that dispatched functions of this process may use.
///
/// Highway's own record is not used: every call of hwy::SupportedTargets() resets it to all targets of the processor,
/// which would remove a limit. The processor is queried only once, because that is slow on virtual machines.
class TargetChoice {
 public:
  TargetChoice();

  /// Returns the targets that the program was compiled for and this processor supports, as a mask of HWY_AVX2 etc.
  std::int64_t available() const { return available_; }

  /// Returns the targets within the limit.
  std::int64_t enabled() const { return enabled_; }

  /// Limits the targets to those in `mask`.
  void limit(std::int64_t mask) { enabled_ = available_ & mask; }

 private:
  std::int64_t available_;
  std::int64_t enabled_ = available_;
};

/// Returns the choice of this process.
TargetChoice& target_choice();

}  // namespace orrery::math

// The build compiles some sources once per instruction set (orrery_instances in cmake/OrreryRoom.cmake), and defines
// ORRERY_AVX3 etc. for the sources that choose among their functions.
#ifdef ORRERY_AVX3
#define ORRERY_IF_AVX3(...) __VA_ARGS__
#else
#define ORRERY_IF_AVX3(...)
#endif
#ifdef ORRERY_AVX2
#define ORRERY_IF_AVX2(...) __VA_ARGS__
#else
#define ORRERY_IF_AVX2(...)
#endif
#ifdef ORRERY_SSE4
#define ORRERY_IF_SSE4(...) __VA_ARGS__
#else
#define ORRERY_IF_SSE4(...)
#endif
#ifdef ORRERY_STATIC  // a processor that is not x86-64
#define ORRERY_IF_STATIC(...) __VA_ARGS__
#else
#define ORRERY_IF_STATIC(...)
#endif

/// Declares a function in the namespace of each instruction set, e.g. ORRERY_DECLARE_INSTANCES(int area(int width)).
#define ORRERY_DECLARE_INSTANCES(...)               \
  ORRERY_IF_AVX3(namespace N_AVX3 { __VA_ARGS__; }) \
  ORRERY_IF_AVX2(namespace N_AVX2 { __VA_ARGS__; }) \
  ORRERY_IF_SSE4(namespace N_SSE4 { __VA_ARGS__; }) \
  ORRERY_IF_STATIC(namespace HWY_NAMESPACE { __VA_ARGS__; })

/// Pointer to the instance of a declared function for the best enabled instruction set.
#define ORRERY_BEST_INSTANCE(function)                                                                     \
  (ORRERY_IF_AVX3((orrery::math::target_choice().enabled() & HWY_AVX3) != 0 ? &N_AVX3::function :)         \
       ORRERY_IF_AVX2((orrery::math::target_choice().enabled() & HWY_AVX2) != 0 ? &N_AVX2::function :)     \
           ORRERY_IF_SSE4((orrery::math::target_choice().enabled() & HWY_SSE4) != 0 ? &N_SSE4::function :) \
               ORRERY_IF_STATIC(true ? &HWY_NAMESPACE::function :) nullptr)
