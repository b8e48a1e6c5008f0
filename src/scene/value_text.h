// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "math/vec3.h"
#include "scene/scene.h"

namespace orrery::scene {

/// Value of a key in a scene file. A kName is a string or an integer and is stored as a string.
using Value = std::variant<std::int64_t, double, Vec3d, std::string, std::vector<std::string>, Window, bool, Interval,
                           NumbersByType, ColorsByType>;

enum class ValueType {
  kInteger,
  kNumber,
  kVector,
  kText,
  kChoice,
  kChoices,
  kWindow,
  kBoolean,
  kInterval,
  kName,
  kTexts,          ///< a list of strings
  kNumbersByType,  ///< a table from particle types to numbers
  kColorsByType,
};

/// Interval of allowed numbers, closed unless an end is marked open; for a vector it applies to each component.
struct Range {
  double from = 0, to = 0;
  bool from_open = false, to_open = false;
  const char* remedy = "";  ///< what to do instead of a larger number, for messages

  bool contains(double x) const { return (from_open ? x > from : x >= from) && (to_open ? x < to : x <= to); }
  /// Returns the interval for documentation: "0..1", "above 0 and below 180".
  std::string text() const;
  /// Returns the interval for messages: "must be in 0..1", "must be above 0 and below 180".
  std::string requirement() const;
};

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
