// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "display/develop.h"
#include "display/settings.h"

namespace orrery::display {

/// The settings that refer to the OCIO config by name.
enum class Name { kConfig, kSpace, kWorkingSpace, kDisplay, kView, kLook };

/// A setting that could not be resolved, and why.
struct NameFault {
  Name name;
  base::Error error;
};

/// Result of look_up().
struct LookUp {
  std::vector<NameFault> faults;
  std::optional<Choice> choice;  ///< set if there are no faults
};

/// Resolves the settings as choose() does, but reports all unknown names instead of only the first.
///
/// Domain     `space` is the space of the scene's colours; it and the working space must be scene-linear
/// Errors     base::Error(kUsage) for an exposure that is not finite; errors of the config and its names become faults
LookUp look_up(const Settings& settings, const std::string& space);

/// Returns `preferred` if the display has a view of this name, else the display's default view.
///
/// Domain     the view of the settings is ignored
/// Result     `preferred` also if the config or the display is not found, which look_up() reports
std::string view_or_default(const Settings& settings, const std::string& preferred);

}  // namespace orrery::display
