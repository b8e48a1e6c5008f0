// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenColorIO/OpenColorIO.h>

#include "display/config.h"
#include "display/develop.h"

namespace orrery::display {

/// A display's view, ready to be applied to scene-linear pixels.
struct View {
  Choice choice;
  OCIO_NAMESPACE::ConstCPUProcessorRcPtr processor;  ///< look and view; exposure is not in it
  OCIO_NAMESPACE::ConstProcessorRcPtr transform;     ///< the same, as OCIO's own steps
  bool is_srgb = false;                              ///< what comes out is encoded for an sRGB display
};

/// Looks everything up in the config that `settings` come to.
///
/// Errors     as choose
View find_view(const Settings& settings);

/// The same in a config that is loaded already.
View find_view(const Config& config, const Settings& settings);

// Its steps. Errors: base::Error(kUsage) for a name that the config lacks.

void choose_display(const Config& config, const Settings& settings, Choice& choice);

/// Domain     the display is chosen
void choose_view(const Config& config, const Settings& settings, Choice& choice);

void check_look(const Config& config, const Settings& settings);

}  // namespace orrery::display
