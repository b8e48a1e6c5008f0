// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenColorIO/OpenColorIO.h>

#include "display/config.h"
#include "display/develop.h"
#include "display/settings.h"

namespace orrery::display {

/// A view of a display, ready to be applied to scene-linear pixels.
struct View {
  Choice choice;
  OCIO_NAMESPACE::ConstCPUProcessorRcPtr processor;  ///< look and view, without exposure
  // If the view has looks, for objects in front of a backdrop; null otherwise.
  OCIO_NAMESPACE::ConstCPUProcessorRcPtr looks;  ///< of the view, in the working space
  OCIO_NAMESPACE::ConstCPUProcessorRcPtr page;   ///< without the view's looks
  bool is_srgb = false;                          ///< the output is encoded for an sRGB display
};

/// Loads the config and resolves the settings.
///
/// Errors     those of choose
View find_view(const Settings& settings);

/// The same with a config that is already loaded.
View find_view(const Config& config, const Settings& settings);

}  // namespace orrery::display
