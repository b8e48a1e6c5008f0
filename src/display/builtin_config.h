// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace orrery::display {

/// The text of src/display/config/orrery.ocio, compiled in.
extern const char* const kBuiltinConfig;

}  // namespace orrery::display
