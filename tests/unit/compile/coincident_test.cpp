// SPDX-License-Identifier: Apache-2.0
#include "compile/coincident.h"

#include <gtest/gtest.h>

#include <vector>

#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "support/lit_scenes.h"

namespace orrery::compile {
namespace {

using Numbers = std::vector<std::uint32_t>;

/// Spheres at these places, then rods from these places to the origin.
scene::Scene scene_of(const std::vector<double>& spheres, const std::vector<double>& rods) {
  scene::Scene s = test::dark_stage(16, 9);
  s.spheres.clear();
  for (const double x : spheres) s.spheres.push_back({{x, 0, 0}, 1, 0, ""});
  for (const double x : rods) s.rods.push_back({{x, 0, 0}, {0, 0, 0}, 0.5, {0, 0}});
  return s;
}

TEST(CompileCoincident, ObjectsAreComparedInTheNumberTypeOfThePrecision) {
  const scene::Scene s = scene_of({1, 2, 1, 1 + 0x1p-40}, {3, -3, 3, 3 + 0x1p-40});
  CompiledScene compiled = compile(s);
  EXPECT_EQ(compiled.duplicates, (Numbers{2, 6}));
  compiled.precision = Precision::kFast;
  update_lights(compiled);
  EXPECT_EQ(compiled.duplicates, (Numbers{2, 3, 6, 7}));
  EXPECT_EQ(compiled.duplicates, coincident_objects(compiled));
}

TEST(CompileCoincident, TheOrderOfARodsEndsDoesNotMatter) {
  scene::Scene s = scene_of({}, {3, 3});
  std::swap(s.rods[1].from, s.rods[1].to);
  EXPECT_EQ(compile(s).duplicates, Numbers{1});
}

TEST(CompileCoincident, ObjectsThatSeparateDoNotCoincide) {
  const scene::Scene opening = scene_of({1, 1, 5}, {3, 3});
  scene::Scene closing = opening;
  closing.spheres[1].center.y = 1;
  closing.rods[1].from.y = 1;
  EXPECT_EQ(compile(opening).duplicates, (Numbers{1, 4}));
  EXPECT_TRUE(compile(opening, &closing).duplicates.empty());
  closing = opening;
  for (scene::Sphere& sphere : closing.spheres) sphere.center.y = 1;
  for (scene::Rod& rod : closing.rods) rod.from.y = 1;
  EXPECT_EQ(compile(opening, &closing).duplicates, (Numbers{1, 4}));
}

TEST(CompileCoincident, SpheresThatAreKnownToDifferAreNotCompared) {
  scene::Scene s = scene_of({1, 1}, {3, 3});
  s.distinct_in = scene::Precision::kExact;
  CompiledScene compiled = compile(s);
  EXPECT_EQ(compiled.duplicates, Numbers{3});
  compiled.precision = Precision::kFast;
  EXPECT_EQ(coincident_objects(compiled), (Numbers{1, 3})) << "distinct doubles may be equal floats";
}

}  // namespace
}  // namespace orrery::compile
