// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "display/develop.h"

namespace orrery::display {

/// What a scene, an option or the environment gives a name of.
enum class Name { kConfig, kSpace, kWorkingSpace, kDisplay, kView, kLook };

struct NameFault {
  Name name;
  base::Error error;
};

struct LookUp {
  std::vector<NameFault> faults;
  std::optional<Choice> choice;  ///< where there is no fault
};

/// Looks up all names in a config, where choose() ends at the first that it lacks.
///
/// `space` is that of the scene's colours. It and the working space must be scene-linear.
///
/// Errors     of the config and its names are faults; base::Error(kUsage) for an exposure that is not finite
LookUp look_up(const Settings& settings, const std::string& space);

}  // namespace orrery::display
