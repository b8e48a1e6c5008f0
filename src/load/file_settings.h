// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>

#include "load/overrides.h"

namespace orrery::load {

/// The files that settings may name, for programs that let others set only those that were given before.
std::set<std::string> named_files(const Overrides& overrides);

}  // namespace orrery::load
