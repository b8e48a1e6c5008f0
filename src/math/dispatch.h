// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

namespace orrery::math {

/// The Highway targets that dispatched functions of this process may use.
///
/// Highway's own chosen target is not used: every call of hwy::SupportedTargets() resets it to all targets of the
/// processor, which would remove a limit. The processor is queried only once, because that is slow on virtual machines.
class TargetChoice {
 public:
  TargetChoice() : available_(HWY_TARGETS & static_cast<std::int64_t>(hwy::SupportedTargets())) {
    chosen_.Update(available_);
  }

  /// Returns the compiled targets that this processor supports, as a mask of HWY_AVX2 etc.
  std::int64_t available() const { return available_; }

  /// Limits the targets to those in `mask`; the best of them is used from now on.
  void limit(std::int64_t mask) { chosen_.Update(available_ & mask); }

  /// Returns the index of the best target in an HWY_EXPORT table of `size` entries. The table has one entry if only one
  /// target is compiled.
  std::size_t index(std::size_t size) const { return size == 1 ? 0 : chosen_.GetIndex(); }

 private:
  std::int64_t available_;
  hwy::ChosenTarget chosen_;
};

/// Returns the choice of this process.
inline TargetChoice& target_choice() {
  static TargetChoice choice;
  return choice;
}

}  // namespace orrery::math

/// Pointer to the instance of an HWY_EXPORTed function for the best enabled target.
#define ORRERY_BEST(function)                                                                              \
  (HWY_DISPATCH_TABLE(function)[orrery::math::target_choice().index(sizeof(HWY_DISPATCH_TABLE(function)) / \
                                                                    sizeof(HWY_DISPATCH_TABLE(function)[0]))])
