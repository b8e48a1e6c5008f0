// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "base/error.h"
#include "base/text.h"
#include "display/config.h"

namespace orrery::display {

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
  throw base::Error(base::ErrorKind::kUsage, "the OCIO config (" + config.source + ") has no " + what + " `" + name +
                                                 "`" + tried + "; " + (near.empty() ? "" : near + " ") +
                                                 (known.empty() ? "it has none" : "it has " + base::joined(known)));
}

}  // namespace orrery::display
