// SPDX-License-Identifier: Apache-2.0
#include "compile/light_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "compile/environment.h"
#include "support/light_batch.h"
#include "support/lit_scenes.h"

namespace orrery::compile {
namespace {

using math::Vec3d;

scene::Scene random_lamps(int count, std::uint32_t seed) {
  scene::Scene s = test::dark_stage(16, 9);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> at(-10, 10), size(0.001, 0.2), power(0.1, 10);
  for (int i = 0; i < count; ++i) {
    const double x = at(random), y = at(random), z = at(random), r = size(random), light = power(random);
    test::add_lamp(s, {x, y, z}, r, {light, light, light});
  }
  return s;
}

double distance(const double (&a)[3], const kernel::Sphere& s) {
  return std::hypot(a[0] - s.x, a[1] - s.y, a[2] - s.z);
}

TEST(CompileLightTree, EveryNodeBoundsItsEmittersAndHoldsTheirPower) {
  const CompiledScene compiled = compile(random_lamps(200, 1));
  const LightTree& tree = compiled.light_tree;
  ASSERT_EQ(tree.spheres.size(), 200u);
  EXPECT_EQ(std::set<std::uint32_t>(tree.spheres.begin(), tree.spheres.end()).size(), 200u);
  std::vector<kernel::LightRange> ranges = {{0, 200}};
  int nodes = 0;
  while (!ranges.empty()) {
    const kernel::LightRange r = ranges.back();
    ranges.pop_back();
    if (r.end - r.begin < 2) continue;
    const std::uint32_t middle = kernel::Lights::middle(r);
    const kernel::LightNode& node = tree.nodes[middle];
    double power = 0;
    for (std::uint32_t leaf = r.begin; leaf < r.end; ++leaf) {
      const kernel::Sphere s = compiled.spheres[tree.spheres[leaf]];
      EXPECT_LE(distance(node.center, s) + s.radius, node.radius * (1 + 1e-14));
      power += kernel::light_leaf(compiled.view(), tree.spheres[leaf]).power;
    }
    EXPECT_NEAR(node.power, power, 1e-12 * power);
    ++nodes;
    ranges.push_back({r.begin, middle});
    ranges.push_back({middle, r.end});
  }
  EXPECT_EQ(nodes, 199);
  for (std::uint32_t leaf = 0; leaf < 200; ++leaf) EXPECT_EQ(tree.view().leaf(tree.spheres[leaf]), leaf);
  EXPECT_EQ(tree.view().leaf(0), kernel::Lights::kNoLeaf) << "the floor";
  EXPECT_EQ(tree.view().leaf(1000), kernel::Lights::kNoLeaf);
}

TEST(CompileLightTree, BlackEmittersAreOmitted) {
  scene::Scene s = test::dark_stage(16, 9);
  test::add_lamp(s, {0, 3, 0}, 1, {0, 0, 0});
  EXPECT_TRUE(compile(s).light_tree.spheres.empty());
  test::add_lamp(s, {0, 5, 0}, 1, {0, 1e-30, 0});
  EXPECT_EQ(compile(s).light_tree.spheres, std::vector<std::uint32_t>{3});
}

TEST(CompileLightTree, SpheresThatCoincideWithAnEarlierOneAreOmitted) {
  scene::Scene s = test::dark_stage(16, 9);
  test::add_lamp(s, {0, 5, 0}, 1, {1, 1, 1});
  test::add_lamp(s, {0, 5, 0}, -1, {2, 2, 2});
  test::add_lamp(s, {0, 5, 0}, 1.5, {2, 2, 2});
  test::add_lamp(s, s.spheres[1].center, s.spheres[1].radius, {3, 3, 3});
  std::vector<std::uint32_t> spheres = compile(s).light_tree.spheres;
  std::sort(spheres.begin(), spheres.end());
  EXPECT_EQ(spheres, (std::vector<std::uint32_t>{2, 4}));
}

TEST(CompileLightTree, HalvesOfRodsAreEmitters) {
  scene::Scene s = test::dark_stage(16, 9);
  s.rods.push_back({{1, 0, 0}, {1, 2, 0}, 0.1, {0, 0}});        // ids 2 and 3
  test::add_rod_lamp(s, {0, 2, 0}, {0, 4, 0}, 0.1, {1, 2, 3});  // 4 and 5
  test::add_rod_lamp(s, {0, 4, 0}, {0, 2, 0}, 0.1, {5, 5, 5});  // coincides with the one before
  test::add_rod_lamp(s, {3, 3, 3}, {3, 3, 3}, 0.1, {1, 1, 1});  // 8, without a second half
  test::add_rod_lamp(s, {5, 0, 0}, {5, 6, 0}, 0.5, {1, 1, 1});  // 10 and 11
  s.rods.back().materials[0] = 0;
  const CompiledScene compiled = compile(s);
  std::vector<std::uint32_t> ids = compiled.light_tree.spheres;
  std::sort(ids.begin(), ids.end());
  EXPECT_EQ(ids, (std::vector<std::uint32_t>{4, 5, 8, 11}));
  const kernel::LightNode lamp = kernel::light_leaf(compiled.view(), 11);
  EXPECT_EQ(math::vector_of(lamp.center), (Vec3d{5, 4.5, 0}));
  EXPECT_EQ(lamp.radius, 1.5 + 0.5);
  EXPECT_EQ(lamp.power, 3 * 0.5 * (3 + 0.5) / 2);
  EXPECT_EQ(kernel::light_leaf(compiled.view(), 8).power, 3 * 0.1 * 0.1 / 2);
}

TEST(CompileLightTree, LightOfMovingRodsIsBounded) {
  scene::Scene s = test::dark_stage(16, 9);
  test::add_rod_lamp(s, {0, 2, 0}, {0, 4, 0}, 0.1, {1, 1, 1});
  scene::Scene closing = s;
  closing.rods[0] = {{3, 2, 0}, {9, 9, 1}, 0.3, s.rods[0].materials};
  const CompiledScene compiled = compile(s, &closing);
  const kernel::RodArray rods = compiled.view().rods;
  for (const std::uint32_t half : {0U, 1U}) {
    const kernel::LightNode lamp = kernel::light_leaf(compiled.view(), rods.id(0) + half);
    for (const double time : {0.0, 0.5, 1.0}) {
      const kernel::Rod rod = rods.at(0, time);
      const Vec3d end = math::vector_of(half == 0 ? rod.a : rod.b),
                  middle = (math::vector_of(rod.a) + math::vector_of(rod.b)) / 2;
      for (const Vec3d& at : {end, middle})
        EXPECT_LE(length(at - math::vector_of(lamp.center)) + rod.radius, lamp.radius * (1 + 1e-14));
    }
  }
}

TEST(CompileLightTree, IsBuiltAgainForAnotherPrecisionOrSampling) {
  scene::Scene s = test::dark_stage(16, 9);
  test::add_lamp(s, {0, 5, 0}, 1, {1, 1, 1});
  test::add_lamp(s, {0, 5 + 1e-12, 0}, 1, {1, 1, 1});
  for (const auto distinct_in : {std::optional<scene::Precision>(), std::optional(scene::Precision::kExact)}) {
    s.distinct_in = distinct_in;
    CompiledScene compiled = compile(s);
    const auto lights = [&] {
      update_lights(compiled);
      return compiled.light_tree.spheres.size();
    };
    EXPECT_EQ(lights(), 2u);
    compiled.precision = Precision::kFast;
    EXPECT_EQ(lights(), 1u);
    compiled.precision = Precision::kBook;
    EXPECT_EQ(lights(), 2u);
    compiled.direct_lighting = kernel::DirectLighting::kBsdf;
    EXPECT_EQ(lights(), 0u);
    compiled.direct_lighting = kernel::DirectLighting::kLight;
    EXPECT_EQ(lights(), 2u);
  }
}

TEST(CompileLightTree, NoTreeIfLightsAreNotSampled) {
  scene::Scene s = random_lamps(3, 1);
  s.render.direct_lighting = scene::DirectLighting::kBsdf;
  EXPECT_TRUE(compile(s).light_tree.spheres.empty());
  EXPECT_FALSE(compile(s).emission.empty());
  EXPECT_TRUE(compile(test::dark_stage(16, 9)).emission.empty());
}

TEST(CompileLightTree, FortyEightBytesPerEmitter) {
  EXPECT_LE(compile(random_lamps(1000, 2)).light_tree.bytes(), 48u * 1000u);
  scene::Scene million = random_lamps(1, 2);
  while (million.spheres.size() < 1'000'002) million.spheres.push_back(million.spheres.back());
  for (std::size_t i = 2; i < million.spheres.size(); ++i) million.spheres[i].center.x = static_cast<double>(i);
  const CompiledScene compiled = compile(million);
  const auto start = std::chrono::steady_clock::now();
  const LightTree tree = build_light_tree(compiled.view());
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  EXPECT_EQ(tree.spheres.size(), 1'000'000u);
  EXPECT_LE(tree.bytes(), 48u * 1'000'000u);
  std::printf("1e6 emitters: light tree built in %.2f s, %.1f bytes each\n", seconds.count(),
              static_cast<double>(tree.bytes()) / 1e6);
}

/// Three or a hundred emitters around other spheres take no table of all ids.
TEST(CompileLightTree, MemoryDependsOnTheEmittersAlone) {
  for (const int count : {3, 100}) {
    scene::Scene s = random_lamps(count, 2);
    std::swap(s.spheres.front(), s.spheres.back());
    s.spheres.insert(s.spheres.begin() + 1, 100'000, s.spheres.back());
    const CompiledScene compiled = compile(s);
    const LightTree& tree = compiled.light_tree;
    ASSERT_EQ(tree.spheres.size(), static_cast<std::size_t>(count));
    EXPECT_LE(tree.bytes(), 48U * static_cast<std::size_t>(count));
    const kernel::Lights lights = tree.view();
    for (std::uint32_t leaf = 0; leaf < lights.count; ++leaf) EXPECT_EQ(lights.leaf(tree.spheres[leaf]), leaf);
    for (const std::uint32_t id : {1U, 50'000U, 100'001U + static_cast<std::uint32_t>(count), 0xffffffffU})
      EXPECT_EQ(lights.leaf(id), kernel::Lights::kNoLeaf) << id;
  }
}

TEST(CompileLightTree, MovingEmittersAreBoundedDuringTheirWholeMotion) {
  scene::Scene open = random_lamps(100, 3), closed = open;
  for (std::size_t i = 2; i < closed.spheres.size(); ++i) {
    closed.spheres[i].center = closed.spheres[i].center + Vec3d{0.5, -0.25, static_cast<double>(i)};
    closed.spheres[i].radius *= 2;
  }
  const CompiledScene compiled = compile(open, &closed);
  const kernel::SceneView view = compiled.view();
  const kernel::LightNode& root = compiled.light_tree.nodes[50];
  for (std::uint32_t id = 2; id < 102; ++id)
    for (const double time : {0.0, 0.5, 1.0}) {
      const kernel::Sphere s = kernel::sphere_at(view, id, time);
      EXPECT_LE(distance(root.center, s) + s.radius, root.radius * (1 + 1e-14));
    }
}

/// Points outside, among and far from the lamps, with normals to and away from them.
std::vector<std::pair<Vec3d, Vec3d>> vertices() {
  return {{{0, 0, 0}, {0, 1, 0}},    {{3, -2, 1}, {0, 0, -1}},     {{30, 0, 0}, {1, 0, 0}},
          {{30, 1, 2}, {-1, 0, 0}},  {{1e6, 0, 0}, {-1, 0, 0}},    {{0, -1e9, 0}, {0, 1, 0}},
          {{0, 10.5, 0}, {0, 1, 0}}, {{9.9, 9.9, 9.9}, {0, -1, 0}}};
}

/// The probability of the choice of each sphere; 0 for the first two, which are no emitters.
std::vector<double> probabilities(const CompiledScene& compiled, Vec3d point, Vec3d normal) {
  std::vector<double> out(compiled.spheres.size());
  for (std::uint32_t id = 2; id < out.size(); ++id)
    out[id] = test::choice_probability(compiled.view(), point, normal, id);
  return out;
}

TEST(KernelLights, ProbabilitiesOfAllEmittersSumToAtMostOne) {
  const CompiledScene compiled = compile(random_lamps(157, 4));
  for (const auto& [point, normal] : vertices()) {
    double sum = 0;
    for (const std::uint32_t id : compiled.light_tree.spheres)
      sum += test::choice_probability(compiled.view(), point, normal, id);
    // Less than one: a bounding sphere may reach above the horizon although no emitter in it does.
    EXPECT_LE(sum, 1 + 1e-12);
    if (std::abs(point.x) < 1e5 && normal.x <= 0 && point.y < 10) {
      EXPECT_GT(sum, 0.5);
    }
  }
}

TEST(KernelLights, ChoicesHaveTheProbabilityThatIsReported) {
  const CompiledScene compiled = compile(random_lamps(137, 5));
  for (const auto& [point, normal] : vertices()) {
    constexpr int kDraws = 10000;
    const std::vector<double> probability = probabilities(compiled, point, normal);
    std::vector<int> count(probability.size());
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (int i = 0; i < kDraws; ++i) {
      const test::Choice c = test::choose_light(compiled.view(), point, normal, (i + 0.5) / kDraws, uniform(random));
      if (c.probability == 0) continue;
      ++count[c.sphere];
      ASSERT_NEAR(c.probability, probability[c.sphere], 1e-14 * c.probability);
    }
    for (std::size_t id = 2; id < count.size(); ++id) EXPECT_NEAR(count[id], probability[id] * kDraws, 6) << id;
  }
}

/// Few emitters are chosen with the probability of their importance itself, without bounds of groups.
TEST(KernelLights, FewEmittersAreChosenWithTheReportedProbability) {
  for (int lamps = 1; lamps <= static_cast<int>(kernel::Lights::kFew) + 1; ++lamps) {
    const CompiledScene compiled = compile(random_lamps(lamps, 5));
    const kernel::SceneView view = compiled.view();
    for (const auto& [point, normal] : vertices()) {
      constexpr int kDraws = 400;
      const std::vector<double> probability = probabilities(compiled, point, normal);
      std::vector<int> count(probability.size());
      double sum = 0;
      for (int i = 0; i < kDraws; ++i) {
        const test::Choice c = test::choose_light(view, point, normal, (i + 0.5) / kDraws, 0.5);
        if (c.probability == 0) continue;
        ++count[c.sphere];
        ASSERT_NEAR(c.probability, probability[c.sphere], 1e-14 * c.probability);
      }
      for (std::size_t id = 2; id < count.size(); ++id) {
        EXPECT_NEAR(count[id], probability[id] * kDraws, view.lights.few() ? 1.01 : 3) << id;
        sum += probability[id];
      }
      if (view.lights.few()) {
        EXPECT_TRUE(std::abs(sum - 1) < 1e-14 || sum == 0) << sum;
      }
    }
  }
}

TEST(KernelLights, TheTreeHasAThirdOfTheErrorOfChoosingByPower) {
  // The exact variance of a light sample without occlusion, for the light of small spheres: power cos / distance^2.
  const CompiledScene compiled = compile(random_lamps(10000, 8));
  const kernel::SceneView view = compiled.view();
  double power = 0;
  for (const std::uint32_t id : compiled.light_tree.spheres) power += kernel::light_leaf(view, id).power;
  double error2_of_power = 0, error2_of_tree = 0;
  for (const auto& [point, normal] : vertices()) {
    if (math::length(point) > 20) continue;
    double light = 0, by_power = 0, by_tree = 0;
    for (const std::uint32_t id : compiled.light_tree.spheres) {
      const kernel::LightNode lamp = kernel::light_leaf(view, id);
      const Vec3d to = Vec3d{lamp.center[0], lamp.center[1], lamp.center[2]} - point;
      const double d2 = math::dot(to, to), cosine = math::dot(to, normal) / std::sqrt(d2);
      if (cosine <= 0 || d2 < lamp.radius * lamp.radius) continue;
      const double value = lamp.power * cosine / std::max(d2, 0.01);
      light += value;
      by_power += value * value / (lamp.power / power);
      by_tree += value * value / test::choice_probability(view, point, normal, id);
    }
    if (light == 0) continue;
    error2_of_power += by_power / (light * light) - 1;
    error2_of_tree += by_tree / (light * light) - 1;
  }
  const double ratio = std::sqrt(error2_of_tree / error2_of_power);
  std::printf("10,000 emitters: error of choosing by the tree / by power %.2f\n", ratio);
  EXPECT_LT(ratio, 1.0 / 3);
}

TEST(KernelLights, ScalingTheSceneByAPowerOfTwoChangesNoChoice) {
  scene::Scene s = random_lamps(160, 6);
  const CompiledScene compiled = compile(s);
  for (scene::Sphere& sphere : s.spheres) {
    sphere.center = sphere.center * 0x1p40;
    sphere.radius *= 0x1p40;
  }
  const CompiledScene scaled = compile(s);
  EXPECT_EQ(compiled.light_tree.spheres, scaled.light_tree.spheres);
  for (const auto& [point, normal] : vertices())
    for (const double u : {0.1, 0.4, 0.7, 0.95}) {
      const test::Choice a = test::choose_light(compiled.view(), point, normal, u, 0.3);
      const test::Choice b = test::choose_light(scaled.view(), point * 0x1p40, normal, u, 0.3);
      EXPECT_EQ(a.sphere, b.sphere);
      EXPECT_EQ(a.probability, b.probability);
    }
}

TEST(KernelLights, ALightThatIsPartlyAboveTheHorizonCanBeChosen) {
  // Two lamps below the horizon, the second reaches above it by a hair's breadth.
  scene::Scene s = test::dark_stage(16, 9);
  test::add_lamp(s, {3, -1, 0}, 0.99, {1, 1, 1});
  test::add_lamp(s, {-3, -1, 0}, 1.0001, {1, 1, 1});
  const CompiledScene compiled = compile(s);
  EXPECT_EQ(test::choice_probability(compiled.view(), {0, 0, 0}, {0, 1, 0}, 2), 0);
  EXPECT_EQ(test::choice_probability(compiled.view(), {0, 0, 0}, {0, 1, 0}, 3), 1);
}

TEST(KernelLights, IrradianceOfASphereIsExactAtAnyDistance) {
  // Quadrature over the sampler: E = pi L (r / d)^2 for a light overhead. The integrand is linear in u.
  double largest = 0;
  for (const double excess : {1e-13, 1e-10, 1e-6, 1e-3, 0.1, 1.0, 9.0, 1e3, 1e6, 1e9, 1e12, 1e15, 1e18}) {
    const double distance = 1 + excess;
    double mean = 0;
    constexpr int kSteps = 64;
    for (int i = 0; i < kSteps; ++i) {
      const test::VisiblePoint p = test::visible_point({0, 0, distance}, 1, (i + 0.5) / kSteps, 0.3);
      mean += p.direction.z / kSteps;
      EXPECT_NEAR(math::length(p.direction), 1, 1e-15);
      EXPECT_NEAR(math::length(p.normal), 1, 1e-15);
    }
    const double expected = std::numbers::pi / (distance * distance);
    const double error = mean * test::visible_point({0, 0, distance}, 1, 0.5, 0.5).solid_angle / expected - 1;
    EXPECT_LE(std::abs(error), 1e-12) << distance;
    largest = std::max(largest, std::abs(error));
  }
  std::printf("irradiance of a sphere, distance / radius 1 + 1e-13 .. 1e18: largest relative error %.1e\n", largest);
}

TEST(KernelLights, IrradianceOfASphereThatTheHorizonCuts) {
  double largest = 0;
  for (const double height : {-0.5, -0.1, 0.2, 0.7}) {
    const Vec3d center{3, 0, height};
    const double distance = math::length(center);
    const double angle = std::acos(height / distance), half_apex = std::asin(1 / distance);
    // Quadrature over the rings of the cone; the part of a ring above the horizon has a closed form.
    double expected = 0;
    constexpr int kRings = 200000;
    for (int i = 0; i < kRings; ++i) {
      const double theta = half_apex * (i + 0.5) / kRings;
      const double at_center = std::cos(angle) * std::cos(theta), across = std::sin(angle) * std::sin(theta);
      const double phi = std::acos(std::clamp(-at_center / across, -1.0, 1.0));
      expected += 2 * (at_center * phi + across * std::sin(phi)) * std::sin(theta) * half_apex / kRings;
    }
    double mean = 0;
    constexpr int kSteps = 1500;
    for (int i = 0; i < kSteps; ++i)
      for (int j = 0; j < kSteps; ++j)
        mean += std::max(0.0, test::visible_point(center, 1, (i + 0.5) / kSteps, (j + 0.5) / kSteps).direction.z);
    mean /= 1.0 * kSteps * kSteps;
    const double error = mean * test::visible_point(center, 1, 0.5, 0.5).solid_angle / expected - 1;
    EXPECT_LE(std::abs(error), 1e-6) << height;
    largest = std::max(largest, std::abs(error));
  }
  std::printf("irradiance of a sphere cut by the horizon: largest relative error %.1e\n", largest);
}

TEST(KernelLights, SampledPointsLieOnTheSphereAlongTheDirectionAndFaceTheViewer) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (const double distance : {1.0001, 1.5, 3.0, 100.0, 1e7}) {
    for (int i = 0; i < 1000; ++i) {
      const Vec3d axis = math::normalized(Vec3d{uniform(random) - 0.5, uniform(random) - 0.5, uniform(random) - 0.5});
      const Vec3d center = axis * distance;
      const test::VisiblePoint p = test::visible_point(center, 1, uniform(random), uniform(random));
      EXPECT_LE(math::dot(p.normal, p.direction), 1e-6);
      const Vec3d point = center + p.normal;
      EXPECT_NEAR(math::length(math::cross(point, p.direction)), 0, 1e-14 * distance * distance);
    }
  }
}

}  // namespace
}  // namespace orrery::compile
