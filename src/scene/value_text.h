// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "math/vec3.h"

namespace orrery::scene {

/// Formats a double for a scene file as the shortest decimal that reads back to the same bits: "0.1", "-0.0", "1e+18".
std::string number_text(double value);

/// Formats a vector for a scene file: "[0, 1, 0]".
std::string vector_text(math::Vec3d value);

/// Formats a string for a scene file, with quotes and escapes.
std::string string_text(const std::string& value);

/// Formats a list of strings for a scene file: ["a", "b"].
std::string list_text(const std::vector<std::string>& values);

/// Removes the quotes of a string_text() without escapes; returns other text unchanged.
std::string unquoted(const std::string& text);

}  // namespace orrery::scene
