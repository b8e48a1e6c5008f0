// SPDX-License-Identifier: Apache-2.0
#include "render/object_at.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "render/render.h"
#include "scene/scene.h"

namespace orrery::render {
namespace {

/// What is picked in the middle of an image of objects in a row.
///
/// `opacities`  of the objects, nearest first
std::optional<std::uint32_t> picked(const std::vector<double>& opacities, scene::Precision precision) {
  scene::Scene s;
  s.image = {9, 9};
  s.camera.look_from = {0, 0, 5};
  s.camera.look_at = {0, 0, 0};
  s.render.precision = precision;
  for (std::size_t i = 0; i < opacities.size(); ++i) {
    s.materials.push_back({std::to_string(i), scene::Lambertian{{0.5, 0.5, 0.5}, {}, opacities[i]}});
    s.spheres.push_back({{0, 0, -3.0 * static_cast<double>(i)}, 1, static_cast<std::uint32_t>(i), ""});
  }
  const compile::CompiledScene compiled = compile::compile(s);
  return object_at(compiled, *build(compiled, 1), 4.5, 4.5);
}

TEST(RenderObjectAt, PicksTheObjectThatIsMostVisible) {
  for (const auto precision : {scene::Precision::kExact, scene::Precision::kFast}) {
    EXPECT_EQ(picked({1, 1}, precision), 0u);
    EXPECT_EQ(picked({0.7, 1}, precision), 0u);
    EXPECT_EQ(picked({0.3, 1}, precision), 1u);
    EXPECT_EQ(picked({0.1, 0.1, 0.1, 1, 1}, precision), 3u);
    EXPECT_EQ(picked({0.1}, precision), 0u) << "the background is not picked where there is an object";
    EXPECT_EQ(picked({0, 0.2}, precision), 1u);
    EXPECT_EQ(picked({0}, precision), std::nullopt);
  }
}

}  // namespace
}  // namespace orrery::render
