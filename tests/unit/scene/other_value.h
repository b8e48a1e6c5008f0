// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scene/schema.h"

namespace orrery::scene {

/// A value of the key's type, inside its range, that is no key's default.
template <class Target>
Value other_value(const Key<Target>& key) {
  switch (key.type) {
    case ValueType::kInteger: return std::int64_t{7};
    case ValueType::kNumber: return 0.375;
    case ValueType::kVector: return Vec3d{0.125, 0.375, 0.625};
    case ValueType::kText:
    case ValueType::kName: return std::string("other");
    case ValueType::kInterval: return Interval{0.25, 0.75};
    case ValueType::kChoice: return key.choices.back();
    case ValueType::kWindow: return Window{1, 2, 3, 4};
    case ValueType::kBoolean: return false;
    case ValueType::kChoices: return std::vector<std::string>{key.choices.back(), key.choices.front()};
    case ValueType::kTexts: return std::vector<std::string>{"x > 0: 0.375"};
    case ValueType::kNumbersByType: return NumbersByType{{"1", 0.375}};
    case ValueType::kColorsByType: return ColorsByType{{"1", {0.125, 0.375, 0.625}}};
  }
  return {};
}

}  // namespace orrery::scene
