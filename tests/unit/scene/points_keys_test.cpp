// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "scene/schema.h"
#include "unit/scene/other_value.h"

namespace orrery::scene {
namespace {

TEST(ScenePointsKeys, EachPointsKeySetsItsOwnMemberAndNoOther) {
  const PointsKeys defaults;
  for (const auto& key : points_keys()) {
    PointsKeys points;
    key.set(points, key.type == ValueType::kBoolean ? Value(true) : other_value(key));
    for (const auto& other : points_keys())
      EXPECT_EQ(other.text(points) == other.text(defaults), &other != &key) << key.name << " and " << other.name;
  }
}

}  // namespace
}  // namespace orrery::scene
