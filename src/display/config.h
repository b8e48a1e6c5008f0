// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenColorIO/OpenColorIO.h>

#include <string>
#include <vector>

namespace orrery::display {

/// An OCIO config and where it came from.
struct Config {
  OCIO_NAMESPACE::ConstConfigRcPtr config;
  std::string source;                 ///< "built-in", or the config's file
  std::vector<std::string> warnings;  ///< what OCIO had to say about it and would have printed
};

/// Loads a config: the file, else $OCIO, else the built-in one. OCIO's own fallback, a config without any display but
/// a message on the console, is never reached.
///
/// Domain     an empty file or an empty $OCIO counts as none
/// Errors     base::Error: kMissingInput, kBadData with OCIO's reason
Config load_config(const std::string& file);

}  // namespace orrery::display
