// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "math/vec3.h"

namespace orrery::scene {

/// A double as the shortest decimal that reads back to the same bits, as a scene file writes it: "0.1", "-0.0",
/// "1e+18".
std::string number_text(double value);

/// "[0, 1, 0]".
std::string vector_text(math::Vec3d value);

/// With quotes and escapes, as a scene file writes it.
std::string string_text(const std::string& value);

/// ["a", "b"].
std::string list_text(const std::vector<std::string>& values);

/// The word out of a string_text that has no escapes.
std::string unquoted(const std::string& text);

}  // namespace orrery::scene
