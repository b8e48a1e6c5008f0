// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "app/layers.h"
#include "image/write.h"

namespace orrery::app {

/// What a Cryptomatte's header says: its name, how names became numbers, and the names.
///
/// Reference  cryptomatte-1.2
std::vector<image::Attribute> matte_attributes(const std::vector<MatteNames>& mattes);

}  // namespace orrery::app
