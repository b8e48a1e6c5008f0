// SPDX-License-Identifier: Apache-2.0
// Of spheres or rods that coincide, only the first is rendered.
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "film/picture.h"
#include "render/render.h"
#include "render/result.h"
#include "render/seen_emitters.h"
#include "render/settings.h"
#include "support/everything.h"
#include "support/lit_scenes.h"

namespace orrery::render {
namespace {

/// A sphere of one material that covers half of the image, under a white sky.
scene::Scene furnace(const scene::MaterialModel& material) {
  scene::Scene s;
  s.image = {16, 16};
  s.camera.look_from = {0, 0, 3};
  s.camera.look_at = {0, 0, 0};
  s.camera.vfov = 50;
  s.background.bottom = s.background.top = {1, 1, 1};
  s.render.samples = 16;
  s.render.max_depth = 100;
  s.materials = {{"one", material}, {"black", scene::Lambertian{{0, 0, 0}}}};
  s.spheres = {{{0, 0.25, 0}, 1, 0, ""}};
  return s;
}

void add_point(scene::Scene& s, math::Vec3d center, double radius, std::uint32_t material) {
  s.points.emplace_back();
  s.points.back().material = material;
  s.points.back().centers = {center};
  s.points.back().radii = {radius};
}

struct Outcome {
  std::vector<float> values;
  std::uint64_t rays = 0;
  friend bool operator==(const Outcome&, const Outcome&) = default;
};

Outcome outcome(const scene::Scene& s, const scene::Scene* closing, std::optional<accel::Traversal> traversal) {
  Settings settings;
  settings.traversal = traversal;
  const Result result = render(compile::compile(s, closing), settings);
  Outcome out;
  out.rays = result.statistics.rays;
  for (const film::Plane& plane : result.picture.planes)
    out.values.insert(out.values.end(), plane.values.begin(), plane.values.end());
  return out;
}

/// Expects the same image from the same number of rays for both scenes, with packets, single rays and the list, in
/// every precision.
void expect_equal(scene::Scene a, scene::Scene b, const std::string& what, const scene::Scene* a_closing = nullptr,
                  const scene::Scene* b_closing = nullptr) {
  for (const auto precision : {scene::Precision::kExact, scene::Precision::kFast, scene::Precision::kBook}) {
    for (const auto accelerator : {scene::Accelerator::kEmbree, scene::Accelerator::kList}) {
      for (const accel::Traversal traversal : {accel::Traversal::kPacket, accel::Traversal::kSingle}) {
        a.render.precision = b.render.precision = precision;
        a.render.accelerator = b.render.accelerator = accelerator;
        EXPECT_TRUE(outcome(a, a_closing, traversal) == outcome(b, b_closing, traversal))
            << what << ", precision " << static_cast<int>(precision) << ", accelerator "
            << static_cast<int>(accelerator) << ", traversal " << static_cast<int>(traversal);
      }
    }
  }
}

TEST(RenderCoincident, OnlyTheFirstSphereIsRendered) {
  const std::pair<const char*, scene::MaterialModel> materials[] = {
      {"grey", scene::Lambertian{{0.5, 0.5, 0.5}}},
      {"white", scene::Lambertian{{1, 1, 1}}},
      {"metal", scene::Metal{{0.5, 0.5, 0.5}, 0}},
      {"glass", scene::Dielectric{1.5, scene::Fresnel::kExact}},
  };
  for (const auto& [name, material] : materials) {
    const scene::Scene one = furnace(material);
    for (const double radius : {1.0, -1.0}) {
      scene::Scene more = one;
      for (const std::uint32_t other : {0u, 1u}) more.spheres.push_back({{0, 0.25, -0.0}, radius, other, ""});
      add_point(more, {0, 0.25, 0}, radius, 1);
      expect_equal(one, more, std::string(name) + " and radius " + std::to_string(radius));
    }
  }
}

/// A path hits a convex sphere at most once, so the value is known.
TEST(RenderCoincident, GreySphereInAWhiteFurnaceIsHalf) {
  scene::Scene s = furnace(scene::Lambertian{{0.5, 0.5, 0.5}});
  s.spheres.push_back(s.spheres[0]);
  s.camera.look_at = s.spheres[0].center;
  s.camera.vfov = 5;
  for (const float value : outcome(s, nullptr, std::nullopt).values) ASSERT_TRUE(value == 0.5f || value == 1.0f);
  EXPECT_EQ(outcome(s, nullptr, std::nullopt).values[0], 0.5f);
}

/// Duplicates every sphere, including the ground, an outlier outside the BVH, and a point within one points file.
TEST(RenderCoincident, DuplicatedSceneEqualsTheScene) {
  const scene::Scene once = test::everything();
  scene::Scene twice = once;
  twice.spheres.insert(twice.spheres.end(), once.spheres.begin(), once.spheres.end());
  expect_equal(once, twice, "spheres");
  scene::Scene points = once;
  add_point(points, {0.2, 0.2, 2}, 0.2, 0);
  scene::Scene points_twice = points;
  points_twice.points[0].centers.push_back(points.points[0].centers[0]);
  points_twice.points[0].radii.push_back(points.points[0].radii[0]);
  expect_equal(points, points_twice, "points");
}

TEST(RenderCoincident, SpheresWithEqualMotionCoincide) {
  scene::Scene one = furnace(scene::Lambertian{{0.5, 0.5, 0.5}});
  scene::Scene one_closing = one;
  one_closing.spheres[0].center.x = 0.5;
  scene::Scene two = one, two_closing = one_closing;
  two.spheres.push_back({two.spheres[0].center, -1, 1, ""});
  two_closing.spheres.push_back({two_closing.spheres[0].center, -1, 1, ""});
  expect_equal(one, two, "moving", &one_closing, &two_closing);
}

TEST(RenderCoincident, SpheresThatSeparateAreBothRendered) {
  scene::Scene s = furnace(scene::Lambertian{{0.5, 0.5, 0.5}});
  s.spheres.push_back({s.spheres[0].center, 1, 1, ""});
  scene::Scene closing = s;
  closing.spheres[1].center.x = 0.5;
  EXPECT_FALSE(outcome(s, &closing, std::nullopt) == outcome(s, nullptr, std::nullopt));
}

/// The two spheres coincide in single precision but not in double.
TEST(RenderCoincident, FastComparesInSinglePrecision) {
  const scene::Scene one = furnace(scene::Lambertian{{0.5, 0.5, 0.5}});
  scene::Scene two = one;
  two.spheres.push_back({{0, 0.25 + 1e-12, 0}, 1 + 1e-12, 1, ""});
  for (const auto precision : {scene::Precision::kFast, scene::Precision::kExact}) {
    scene::Scene a = one, b = two;
    a.render.precision = b.render.precision = precision;
    EXPECT_EQ(outcome(a, nullptr, std::nullopt) == outcome(b, nullptr, std::nullopt),
              precision == scene::Precision::kFast);
  }
}

TEST(RenderCoincident, SpheresThatAreDistinctInDoubleMayCoincideInSingle) {
  scene::Scene one = furnace(scene::Lambertian{{0.5, 0.5, 0.5}}), two = one;
  two.spheres.push_back({{0, 0.25 + 1e-12, 0}, 1, 1, ""});
  two.distinct_in = scene::Precision::kExact;
  one.render.precision = two.render.precision = scene::Precision::kFast;
  EXPECT_TRUE(outcome(one, nullptr, {}) == outcome(two, nullptr, {}));
}

/// A floor and a ball, without light.
scene::Scene dark_stage() {
  scene::Scene s = test::dark_stage(12, 8);
  s.render.samples = 16;
  s.render.max_depth = 8;
  return s;
}

/// Expects the same image of both scenes however direct light is sampled.
void expect_equal_light(scene::Scene a, scene::Scene b, const std::string& what,
                        const scene::Scene* a_closing = nullptr, const scene::Scene* b_closing = nullptr) {
  for (const auto mode : {scene::DirectLighting::kMis, scene::DirectLighting::kLight, scene::DirectLighting::kBsdf}) {
    a.render.direct_lighting = b.render.direct_lighting = mode;
    expect_equal(a, b, what + ", direct lighting " + std::to_string(static_cast<int>(mode)), a_closing, b_closing);
  }
}

TEST(RenderCoincident, OnlyTheFirstEmitterIsALight) {
  scene::Scene one = dark_stage();
  test::add_lamp(one, {1.5, 2.5, 1}, 0.4, {20, 15, 10});
  scene::Scene more = one;
  more.spheres.push_back(one.spheres.back());
  test::add_lamp(more, {1.5, 2.5, 1}, -0.4, {1, 2, 30}, "other");
  add_point(more, {1.5, 2.5, 1}, 0.4, one.spheres.back().material);
  expect_equal_light(one, more, "lamps");
}

TEST(RenderCoincident, AnEmitterThatCoincidesWithAnEarlierSphereIsNotALight) {
  scene::Scene dark = dark_stage();
  scene::Scene hidden = dark;
  test::add_lamp(hidden, dark.spheres[1].center, dark.spheres[1].radius, {20, 15, 10});
  add_point(hidden, dark.spheres[1].center, dark.spheres[1].radius, hidden.spheres.back().material);
  for (const auto mode : {scene::DirectLighting::kMis, scene::DirectLighting::kLight, scene::DirectLighting::kBsdf}) {
    hidden.render.direct_lighting = mode;
    for (const float value : outcome(hidden, nullptr, std::nullopt).values)
      ASSERT_TRUE(value == 0 || value == 1) << "black, with alpha";
  }
}

TEST(RenderCoincident, OfMovingEmittersOnlyTheFirstIsALight) {
  scene::Scene one = dark_stage();
  test::add_lamp(one, {1.5, 2.5, 1}, 0.4, {20, 15, 10});
  scene::Scene two = one;
  two.spheres.push_back(one.spheres.back());
  scene::Scene one_closing = one, two_closing = two;
  one_closing.spheres[2].center.x = two_closing.spheres[2].center.x = two_closing.spheres[3].center.x = 1;
  expect_equal_light(one, two, "moving lamps", &one_closing, &two_closing);
  two_closing.spheres[3].center.x = 0.5;
  EXPECT_FALSE(outcome(one, &one_closing, {}) == outcome(two, &two_closing, {})) << "lamps that separate are two";
}

TEST(RenderCoincident, OfSmallLampsThatTheCameraSeesOnlyTheFirstIsSampled) {
  scene::Scene one = dark_stage();
  test::add_lamp(one, {0.5, 1, 1}, 0.02, {2000, 1500, 1000});
  scene::Scene two = one;
  test::add_lamp(two, {0.5, 1, 1}, 0.02, {1000, 2000, 3000}, "other");
  const compile::CompiledScene compiled = compile::compile(two);
  ASSERT_NE(SeenEmitterList(compiled.view(), compiled.precision, compiled.width, compiled.height).view().begins,
            nullptr);
  expect_equal_light(one, two, "small lamps");
}

/// Thin, very long and thick rods; half of the last one is dark.
TEST(RenderCoincident, OnlyTheFirstRodIsRenderedAndALight) {
  scene::Scene one = dark_stage();
  test::add_rod_lamp(one, {-2, 2, 0.5}, {1.5, 2.6, 1}, 0.05, {20, 15, 10});
  test::add_rod_lamp(one, {0.5, 0.4, 1.5}, {0.5, 40, 1.5}, 0.02, {20, 20, 20});
  test::add_rod_lamp(one, {-0.4, 1.4, 1}, {0.2, 1.4, 1}, 0.3, {5, 10, 15});
  one.rods.back().materials[1] = 1;
  scene::Scene more = one;
  for (scene::Rod rod : one.rods) {
    std::swap(rod.from, rod.to);
    rod.materials = {0, 0};
    more.rods.insert(more.rods.end(), {rod, rod});
  }
  for (const scene::Rod& rod : one.rods) more.rods.push_back(rod);
  expect_equal_light(one, more, "rods");
  scene::Scene one_closing = one, more_closing = more;
  for (scene::Scene* s : {&one_closing, &more_closing})
    for (scene::Rod& rod : s->rods)
      for (math::Vec3d* end : {&rod.from, &rod.to}) end->x += 0.5;
  expect_equal_light(one, more, "moving rods", &one_closing, &more_closing);
}

/// The two lamps coincide in single precision but not in double.
TEST(RenderCoincident, FastComparesEmittersInSinglePrecision) {
  scene::Scene one = dark_stage();
  test::add_lamp(one, {1.5, 2.5, 1}, 0.4, {20, 15, 10});
  scene::Scene two = one;
  test::add_lamp(two, {1.5, 2.5 + 1e-12, 1}, 0.4 + 1e-12, {10, 15, 20});
  for (const auto distinct_in : {std::optional<scene::Precision>(), std::optional(scene::Precision::kExact)}) {
    two.distinct_in = distinct_in;
    one.render.precision = two.render.precision = scene::Precision::kFast;
    EXPECT_TRUE(outcome(one, nullptr, {}) == outcome(two, nullptr, {}));
    one.render.precision = two.render.precision = scene::Precision::kExact;
    EXPECT_FALSE(outcome(one, nullptr, {}) == outcome(two, nullptr, {}));
  }
}

}  // namespace
}  // namespace orrery::render
