// SPDX-License-Identifier: Apache-2.0
#include "render/outlines.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "render/render.h"
#include "scene/scene.h"

namespace orrery::render {
namespace {

/// Spheres seen along -z by an orthographic camera of width 4.
scene::Scene scene_of(const std::vector<scene::Sphere>& spheres, int side) {
  scene::Scene out;
  out.image = {side, side};
  out.camera.projection = scene::Projection::kOrthographic;
  out.camera.width = 4;
  out.camera.look_from = {0, 0, 20};
  out.camera.look_at = {0, 0, 0};
  out.materials = {{"grey", scene::Lambertian{}}};
  out.spheres = spheres;
  return out;
}

std::vector<float> lines_of(const scene::Scene& scene, double width) {
  const compile::CompiledScene compiled = compile::compile(scene);
  return outlines(compiled, *build(compiled, 1), {width, 0, {}}, 2);
}

double sum(const std::vector<float>& lines) {
  double out = 0;
  for (const float v : lines) out += v;
  return out;
}

TEST(RenderOutlines, HaveTheirWidthAtAnyResolution) {
  for (const int side : {100, 400})
    for (const double width : {1.0, 2.0, 3.5}) {
      const double circumference = 2 * std::numbers::pi * side / 4;
      EXPECT_NEAR(sum(lines_of(scene_of({{{0, 0, 0}, 1}}, side), width)) / circumference, width, 0.3) << side << width;
    }
}

TEST(RenderOutlines, HaveNoGaps) {
  constexpr int kSide = 200;
  const std::vector<float> lines = lines_of(scene_of({{{0, 0, 0}, 1}}, kSide), 2);
  // The densest pixel across the line, in each direction from the centre.
  for (int degree = 0; degree < 360; ++degree) {
    float most = 0;
    for (double r = 46; r <= 54; r += 0.25) {
      const int x = static_cast<int>(100 + r * std::cos(degree * std::numbers::pi / 180)),
                y = static_cast<int>(100 + r * std::sin(degree * std::numbers::pi / 180));
      most = std::max(most, lines[static_cast<std::size_t>(y * kSide + x)]);
    }
    EXPECT_GT(most, 0.8f) << degree;
  }
}

TEST(RenderOutlines, AreAtStepsInDepthOnly) {
  const auto line_at_center = [](double z) {
    // A small sphere in front of a large one; its limb crosses the centre of the image.
    const std::vector<float> lines = lines_of(scene_of({{{-0.3, 0, z}, 0.3}, {{0, 0, -20}, 20}}, 101), 2);
    return lines[50 * 101 + 50];
  };
  EXPECT_GT(line_at_center(1), 0.9f);
  EXPECT_EQ(line_at_center(0), 0) << "half inside the large sphere";
  const std::vector<scene::Sphere> touching = {{{0.25, 0, 0}, 0.5}, {{-0.25, 0, 0}, 0.5}};
  EXPECT_EQ(lines_of(scene_of(touching, 101), 2)[50 * 101 + 50], 0) << "where two spheres intersect";
}

TEST(RenderOutlines, SmallSpheresThatTouchHaveNone) {
  std::vector<scene::Sphere> many;
  for (int x = -40; x <= 40; ++x)
    for (int y = -40; y <= 40; ++y) many.push_back({{x * 0.1, y * 0.1, (x * 7 + y * 3) % 5 * 0.02}, 0.07});
  EXPECT_EQ(sum(lines_of(scene_of(many, 64), 2)), 0);
}

/// The densest pixel near the upper limb of a sphere, and near that of a smaller one behind it.
std::pair<float, float> limbs(double opacity) {
  scene::Scene scene = scene_of({{{0, 0, 0}, 1}, {{0, 0, -3}, 0.5}}, 101);
  scene::Lambertian ghost;
  ghost.opacity = opacity;
  scene.materials.push_back({"ghost", ghost});
  scene.spheres[0].material = 1;
  const std::vector<float> lines = lines_of(scene, 2);
  const auto densest = [&](int row) {
    float out = 0;
    for (int y = row - 2; y <= row + 2; ++y) out = std::max(out, lines[static_cast<std::size_t>(y * 101 + 50)]);
    return out;
  };
  return {densest(25), densest(38)};
}

TEST(RenderOutlines, OfTranslucentObjectsAreAsWeakAsTheObjects) {
  const auto [opaque, hidden] = limbs(1);
  EXPECT_GT(opaque, 0.9f);
  EXPECT_EQ(hidden, 0);
  const auto [weak, behind] = limbs(0.25);
  EXPECT_NEAR(weak, opaque / 4, 0.01);
  EXPECT_GT(behind, 0.9f);
  const auto [strong, hidden_by_strong] = limbs(0.75);
  EXPECT_NEAR(strong, opaque * 0.75, 0.01);
  EXPECT_EQ(hidden_by_strong, 0);
}

/// The line along the upper limb of a sphere.
float limb(const scene::Scene& scene, const OutlineStyle& style, int row) {
  const compile::CompiledScene compiled = compile::compile(scene);
  const std::vector<float> lines = outlines(compiled, *build(compiled, 1), style, 1);
  float out = 0;
  for (int y = row - 3; y <= row + 3; ++y) out += lines[static_cast<std::size_t>(y * 101 + 50)];
  return out;
}

TEST(RenderOutlines, AreAtJumpsOfAChosenDepth) {
  // The smaller sphere is 2.5 in front of the larger one.
  const scene::Scene scene = scene_of({{{0, 0, 3}, 0.5}, {{0, 0, -1}, 2}}, 101);
  EXPECT_NEAR(limb(scene, {2, 1, {}}, 38), 2, 0.3);
  EXPECT_EQ(limb(scene, {2, 3, {}}, 38), 0);
}

TEST(RenderOutlines, BetweenGroupsNeedNoJumpAndAreBolder) {
  const scene::Scene touching = scene_of({{{0, 0.25, 0}, 0.5}, {{0, -0.25, 0}, 0.5}}, 101);
  OutlineStyle style{2, 0, base::PackedArray(2, 1)};
  style.groups.set(0, 0);
  EXPECT_NEAR(limb(touching, style, 50), 2, 0.3) << "two groups";
  style.groups.set(1, 0);
  EXPECT_EQ(limb(touching, style, 50), 0) << "one group";
  const scene::Scene stepped = scene_of({{{0, 0, 3}, 0.5}, {{0, 0, -1}, 2}}, 101);
  style.depth = 2;
  EXPECT_NEAR(limb(stepped, style, 38), 0.6, 0.2) << "half as wide, and weaker";
  style.depth = 0.5;
  EXPECT_NEAR(limb(stepped, style, 38), 2, 0.3) << "far behind";
}

TEST(RenderOutlines, FadeWithTheDepthCue) {
  scene::Scene scene = scene_of({{{0, 0, 0}, 1}}, 101);
  const float full = limb(scene, {2, 0, {}}, 25);
  scene.camera.depth_cue = 0.5;
  scene.camera.depth_cue_range = scene::Interval{10, 15};  // the limb is at 20
  EXPECT_NEAR(limb(scene, {2, 0, {}}, 25), full / 2, 0.02);
  scene.camera.depth_cue_range = scene::Interval{15, 25};
  EXPECT_NEAR(limb(scene, {2, 0, {}}, 25), full * 0.75, 0.02);
}

}  // namespace
}  // namespace orrery::render
