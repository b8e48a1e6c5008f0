// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "math/vec3.h"
#include "scene/value.h"

namespace orrery::scene {

/// Formats a double for a scene file as the shortest decimal that reads back to the same bits: "0.1", "-0.0", "1e+18".
std::string number_text(double value);

/// Formats a vector for a scene file: "[0, 1, 0]".
std::string vector_text(math::Vec3d value);

/// Formats an interval for a scene file: "[0, 12]".
std::string interval_text(const Interval& interval);

/// Formats a string for a scene file, with quotes and escapes.
std::string string_text(const std::string& value);

/// Formats the name of a key for a scene file, with quotes if it needs them.
std::string key_text(const std::string& name);

/// Formats a value for a scene file, on one line.
std::string value_text(const Value& value);

/// Removes the quotes of a string_text() without escapes; returns other text unchanged.
std::string unquoted(const std::string& text);

}  // namespace orrery::scene
