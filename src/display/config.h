// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <OpenColorIO/OpenColorIO.h>

#include "base/error.h"
#include "base/text.h"

namespace orrery::display {

/// An OCIO config and where it came from.
struct Config {
  OCIO_NAMESPACE::ConstConfigRcPtr config;
  std::string name;                   ///< "built-in", or the config file
  std::vector<std::string> warnings;  ///< OCIO's log messages while loading
};

/// Loads a config: the file, else $OCIO, else the built-in one. Never uses OCIO's own fallback, a config without
/// displays.
///
/// Domain     an empty `file` or $OCIO counts as unset
/// Errors     base::Error: kMissingInput, kBadData with OCIO's reason
Config load_config(const std::string& file);

/// Resolves a colour space given by name, alias or role to the config's canonical name. Spaces that orrery knows are
/// also found by the names that other configs use for them.
///
/// Errors     base::Error(kUsage) with all names tried, and similar names
std::string find_color_space(const Config& config, const std::string& name);

/// The same for a scene-linear space; data, log and display spaces are refused.
///
/// Errors     those of find_color_space; base::Error(kUsage) for a space that is not scene-linear
std::string find_scene_linear(const Config& config, const std::string& name);

using Names = std::vector<std::string>;

/// Collects names from an OCIO getter that takes an index.
template <class Get>
Names names(int count, Get get) {
  Names out;
  for (int i = 0; i < count; ++i) out.emplace_back(get(i));
  return out;
}

/// Throws the error for a name that a config does not define; lists the defined names.
[[noreturn]] inline void unknown(const Config& config, const std::string& what, const std::string& name,
                                 const Names& known, const std::string& tried = {}) {
  const std::string near = base::did_you_mean(name, known);
  base::refuse("the OCIO config (" + config.name + ") has no " + what + " `" + name + "`" + tried + "; " +
               (near.empty() ? "" : near + " ") + (known.empty() ? "it has none" : "it has " + base::joined(known)));
}

}  // namespace orrery::display
