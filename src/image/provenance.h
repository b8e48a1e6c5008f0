// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

namespace orrery::image {

/// Origin of a checkpoint or shard as name-value pairs, e.g. "sceneHash" = "0123456789abcdef".
using Provenance = std::map<std::string, std::string>;

}  // namespace orrery::image
