// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

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

}  // namespace orrery::scene
