// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenColorIO/OpenColorIO.h>

#include <string>
#include <vector>

namespace orrery::display {

/// An OCIO config and where it came from.
struct Config {
  OCIO_NAMESPACE::ConstConfigRcPtr config;
  std::string source;                 ///< "built-in", or the config file
  std::vector<std::string> warnings;  ///< OCIO's log messages while loading
};

/// Loads a config: the file, else $OCIO, else the built-in one. Never uses OCIO's own fallback, a config without
/// displays.
///
/// Domain     an empty `file` or $OCIO counts as unset
/// Errors     base::Error: kMissingInput, kBadData with OCIO's reason
Config load_config(const std::string& file);

}  // namespace orrery::display
