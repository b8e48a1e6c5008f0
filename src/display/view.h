// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenColorIO/OpenColorIO.h>

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

}  // namespace orrery::display
