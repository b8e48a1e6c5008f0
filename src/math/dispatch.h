// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

namespace orrery::math {

/// The Highway targets that dispatched functions of this process may use; the one place that knows.
///
/// Highway's own record is not used: every call of hwy::SupportedTargets() resets it to all that the processor has,
/// and would lift a limit. The processor is asked once, which is slow on virtual machines.
class TargetChoice {
 public:
  TargetChoice() : available_(HWY_TARGETS & static_cast<std::int64_t>(hwy::SupportedTargets())) {
    chosen_.Update(available_);
  }

  /// Targets that were compiled and that this processor has, as a mask of HWY_AVX2 etc.
  std::int64_t available() const { return available_; }

  /// Allows the available targets in `mask` only; the best of them is used from now on.
  void limit(std::int64_t mask) { chosen_.Update(available_ & mask); }

  /// The entry of an HWY_EXPORT table with `size` entries. Where only one target is compiled the table has one entry.
  std::size_t index(std::size_t size) const { return size == 1 ? 0 : chosen_.GetIndex(); }

 private:
  std::int64_t available_;
  hwy::ChosenTarget chosen_;
};

inline TargetChoice& target_choice() {
  static TargetChoice choice;
  return choice;
}

}  // namespace orrery::math

/// The instance of an HWY_EXPORTed function for the best instruction set that may be used, as a pointer.
#define ORRERY_BEST(function)                                                                              \
  (HWY_DISPATCH_TABLE(function)[orrery::math::target_choice().index(sizeof(HWY_DISPATCH_TABLE(function)) / \
                                                                    sizeof(HWY_DISPATCH_TABLE(function)[0]))])
