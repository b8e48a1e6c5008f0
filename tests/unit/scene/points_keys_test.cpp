// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "scene/schema.h"
#include "unit/scene/other_value.h"

namespace orrery::scene {
namespace {

TEST(ScenePointsKeys, EachPointsKeySetsItsOwnMemberAndNoOther) {
  const PointsKeys defaults;
  for (const auto& key : points_keys()) {
    if (key.name == "radius.value") continue;  // the member of `radius`
    PointsKeys points;
    key.set(points, key.type == ValueType::kBoolean ? Value(true) : other_value(key));
    for (const auto& other : points_keys())
      EXPECT_EQ(other.text(points) == other.text(defaults), &other != &key) << key.name << " and " << other.name;
  }
}

TEST(ScenePointsKeys, TheRadiusIsInATableIfThereAreConditions) {
  PointsKeys points;
  points.radius.value = 2;
  for (const bool has_conditions : {false, true}) {
    if (has_conditions) points.radius.where = {"x > 1: 3"};
    for (const auto& key : points_keys()) {
      const bool is_in_table = key.name == "radius.value";
      if (!is_in_table && key.name != "radius") continue;
      EXPECT_EQ(key.text(points) == "2", is_in_table == has_conditions);
    }
  }
}

}  // namespace
}  // namespace orrery::scene
