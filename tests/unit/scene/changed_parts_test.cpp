// SPDX-License-Identifier: Apache-2.0
#include "scene/changed_parts.h"

#include <gtest/gtest.h>

#include "scene/scene.h"

namespace orrery::scene {
namespace {

TEST(SceneChangedParts, BondsAreGeometryAndTheirMaterialIsAnAssignment) {
  Scene without, steel, gold;
  for (Scene* const scene : {&without, &steel, &gold}) scene->points.resize(1);
  steel.points[0].bonds.are_drawn = gold.points[0].bonds.are_drawn = true;
  steel.points[0].bonds.material = 1;
  gold.points[0].bonds.material = 2;
  const Parts drawn = changed_parts(without, nullptr, steel, nullptr);
  EXPECT_TRUE(drawn.geometry);
  const Parts exchanged = changed_parts(steel, nullptr, gold, nullptr);
  EXPECT_TRUE(exchanged.assignment);
  EXPECT_FALSE(exchanged.geometry);
  gold = steel;
  gold.points[0].bonds.radius = 0.1;
  EXPECT_TRUE(changed_parts(steel, nullptr, gold, nullptr).geometry);
}

}  // namespace
}  // namespace orrery::scene
