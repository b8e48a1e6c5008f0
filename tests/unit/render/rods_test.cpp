// SPDX-License-Identifier: Apache-2.0
// Images of rods whose values are known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "render/render.h"
#include "render/result.h"
#include "render/settings.h"
#include "support/plane_values.h"

namespace orrery::render {
namespace {

using math::Vec3d;

/// A white sky, and a camera that looks at the origin.
scene::Scene rod_furnace() {
  scene::Scene s;
  s.image = {24, 16};
  s.camera.look_from = {0.5, 0.7, 5};
  s.camera.look_at = {0, 0, 0};
  s.camera.vfov = 30;
  s.background.bottom = s.background.top = {1, 1, 1};
  s.render.samples = 16;
  s.render.max_depth = 100;
  s.materials = {{"grey", scene::Lambertian{{0.5, 0.5, 0.5}}}, {"black", scene::Lambertian{{0, 0, 0}}}};
  return s;
}

scene::Rod rod(Vec3d from, Vec3d to, double radius) {
  scene::Rod out;
  out.from = from;
  out.to = to;
  out.radius = radius;
  return out;
}

std::vector<float> image_of(const scene::Scene& s, const scene::Scene* closing = nullptr,
                            const Settings& settings = {}) {
  return test::plane_values(render(compile::compile(s, closing), settings).picture);
}

Settings with_hit_layers() {
  Settings settings;
  settings.layers.z = settings.layers.position = settings.layers.normal = settings.layers.variance = true;
  return settings;
}

/// The scene in all precisions, with Embree and the list.
void each_way(scene::Scene s, const std::function<void(const scene::Scene&, const std::string&)>& visit) {
  for (const auto precision : {scene::Precision::kExact, scene::Precision::kFast, scene::Precision::kBook})
    for (const auto accelerator : {scene::Accelerator::kEmbree, scene::Accelerator::kList}) {
      s.render.precision = precision;
      s.render.accelerator = accelerator;
      visit(s, "precision " + std::to_string(static_cast<int>(precision)) + ", accelerator " +
                   std::to_string(static_cast<int>(accelerator)));
    }
}

/// Rods and spheres whose union is convex: a path that hits it leaves the scene with half of its light.
struct ConvexSet {
  const char* name;
  std::vector<scene::Rod> rods;
  std::vector<Vec3d> spheres = {};  ///< of the same radius
  /// Points between the ends of the whole are rounded, so that in single precision they are not on one line.
  bool is_rounded = false;
};

std::vector<ConvexSet> convex_sets() {
  const Vec3d a{-1.5, -0.3, 0.2}, b{1.5, 0.6, -0.4};
  const auto at = [&](double s) { return a + (b - a) * s; };
  const double r = 0.35;
  return {{"one", {rod(a, b, r)}},
          {"in a row", {rod(a, at(0.5), r), rod(at(0.5), at(0.75), r), rod(at(0.75), b, r)}, {}, true},
          {"overlapping", {rod(a, at(0.7), r), rod(at(0.3), b, r), rod(at(0.25), at(0.5), r)}, {}, true},
          {"duplicate", {rod(a, b, r), rod(a, b, r), rod(a, b, r)}},
          {"reversed", {rod(a, b, r), rod(b, a, r)}},
          {"with spheres at the ends", {rod(a, b, r)}, {a, b}},
          {"in a row with spheres", {rod(a, at(0.5), r), rod(at(0.5), b, r)}, {a, at(0.5), at(0.75), b}, true},
          {"of length 0 in spheres", {rod(a, a, r)}, {a}}};
}

/// ORRERY_FURNACE_RAYS sets the number of paths of all images, about a hundred.
TEST(RenderRods, GreyRodsInAWhiteFurnaceAreHalf) {
  const char* const wanted = std::getenv("ORRERY_FURNACE_RAYS");
  for (const ConvexSet& set : convex_sets()) {
    for (const double offset : {0.0, 1e6, 1e9}) {
      const Vec3d moved{offset, -offset, offset};
      scene::Scene s = rod_furnace();
      if (wanted != nullptr) s.render.samples = std::max(16, static_cast<int>(std::atof(wanted) / (24 * 16 * 100)));
      s.camera.look_from = s.camera.look_from + moved;
      s.camera.look_at = s.camera.look_at + moved;
      s.rods = set.rods;
      for (scene::Rod& r : s.rods) {
        r.from = r.from + moved;
        r.to = r.to + moved;
      }
      for (const Vec3d center : set.spheres) s.spheres.push_back({center + moved, set.rods[0].radius, 0, ""});
      each_way(s, [&](const scene::Scene& each, const std::string& way) {
        // Spheres have acne in contact with others, except in `exact`, and single precision cannot represent all rods.
        if (each.render.precision != scene::Precision::kExact && !set.spheres.empty()) return;
        if (each.render.precision == scene::Precision::kFast && (offset > 0 || set.is_rounded)) return;
        Settings settings;
        settings.layers.coverage = settings.layers.transparent = true;
        const auto planes = render(compile::compile(each), settings).picture.planes;
        ASSERT_EQ(planes.size(), 4u);
        int covered = 0;
        for (std::size_t i = 0; i < planes[0].values.size(); ++i) {
          const float alpha = planes[3].values[i];
          covered += alpha == 1;
          for (std::size_t k = 0; k < 3; ++k)
            ASSERT_EQ(planes[k].values[i], 0.5F * alpha) << set.name << ", offset " << offset << ", " << way;
        }
        EXPECT_GT(covered, 4) << set.name;
      });
    }
  }
}

/// Rods wholly inside opaque spheres change no bit.
TEST(RenderRods, RodsInsideSpheresAreInvisible) {
  scene::Scene s = rod_furnace();
  s.materials.push_back({"lamp", scene::Emitter{{4, 4, 4}}});
  s.spheres = {{{-0.8, 0, 0}, 0.5, 0, ""}, {{0.8, 0.1, 0}, 0.6, 0, ""}, {{0, 3, 1}, 0.5, 2, ""}};
  scene::Scene with = s;
  std::minstd_rand random(5);
  std::uniform_real_distribution<double> any(-0.28, 0.28);
  for (int i = 0; i < 20; ++i) {
    const Vec3d center = s.spheres[static_cast<std::size_t>(i % 2)].center;
    with.rods.push_back(
        rod(center + Vec3d{any(random), any(random), 0}, center + Vec3d{any(random), 0, any(random)}, 0.08));
    with.rods.back().materials = {1, 1};
  }
  const auto precision_of = [](scene::Scene at, const scene::Scene& like) {
    at.render = like.render;
    return at;
  };
  each_way(with, [&](const scene::Scene& each, const std::string& way) {
    EXPECT_EQ(image_of(each, nullptr, with_hit_layers()), image_of(precision_of(s, each), nullptr, with_hit_layers()))
        << way;
  });
}

/// The ids of layers differ, all other values are equal.
TEST(RenderRods, RodOfLengthZeroIsTheSphere) {
  scene::Scene s = rod_furnace();
  s.materials.push_back({"gold", scene::Metal{{0.8, 0.6, 0.3}, 0.2}});
  s.materials.push_back({"lamp", scene::Emitter{{4, 4, 4}}});
  s.spheres = {{{0, 3, 1}, 0.5, 3, ""}, {{0, -100.5, 0}, 100, 0, ""}};
  scene::Scene as_rods = s;
  for (const auto& [center, radius, material] :
       {std::tuple{Vec3d{-0.9, 0, 0}, 0.5, 0u}, {Vec3d{0.9, 0.1, -0.4}, 0.6, 2u}, {Vec3d{0.1, 0.7, 0.4}, 0.3, 0u}}) {
    s.spheres.push_back({center, radius, material, ""});
    as_rods.rods.push_back(rod(center, center, radius));
    as_rods.rods.back().materials = {material, material};
  }
  each_way(as_rods, [&](const scene::Scene& each, const std::string& way) {
    // The book's formula is another one. In single precision, a ray that leaves a sphere may return to it.
    if (each.render.precision != scene::Precision::kExact) return;
    scene::Scene spheres = s;
    spheres.render = each.render;
    EXPECT_EQ(image_of(each, nullptr, with_hit_layers()), image_of(spheres, nullptr, with_hit_layers())) << way;
  });
}

TEST(RenderRods, EndsInAnyOrderGiveTheSameBits) {
  scene::Scene s = rod_furnace();
  s.rods = {rod({-1, 0, 0}, {1, 0.5, 0.2}, 0.3), rod({0, -1, 0}, {0, 1, -0.5}, 0.2)};
  for (scene::Rod& r : s.rods) r.materials = {0, 1};
  scene::Scene reversed = s;
  for (scene::Rod& r : reversed.rods) {
    std::swap(r.from, r.to);
    std::swap(r.materials[0], r.materials[1]);
  }
  each_way(s, [&](const scene::Scene& each, const std::string& way) {
    scene::Scene other = reversed;
    other.render = each.render;
    EXPECT_EQ(image_of(each), image_of(other)) << way;
  });
  std::swap(reversed.rods[0].materials[0], reversed.rods[0].materials[1]);
  EXPECT_NE(image_of(s), image_of(reversed)) << "the halves have different materials";
}

TEST(RenderRods, EveryAcceleratorThreadCountAndTraversalGivesTheSameBits) {
  scene::Scene s = rod_furnace();
  s.materials.push_back({"lamp", scene::Emitter{{4, 4, 4}}});
  s.spheres = {{{0, 3, 1}, 0.5, 2, ""}, {{0, -100.5, 0}, 100, 0, ""}, {{-1, 0, 0}, 0.4, 0, ""}};
  s.rods = {rod({-1, 0, 0}, {1, 0.5, 0.2}, 0.2), rod({0, -0.4, 0}, {0, 1, -0.5}, 0.01),
            rod({-1, 1, 1}, {1, -0.3, 1}, 0.02)};
  scene::Scene closing = s;
  closing.rods[0].to = {1, 0.2, 0.6};
  closing.rods[1].radius = 0.05;
  for (const scene::Scene* const moved : {static_cast<const scene::Scene*>(nullptr), &std::as_const(closing)})
    for (const auto precision : {scene::Precision::kExact, scene::Precision::kFast, scene::Precision::kBook}) {
      s.render.precision = precision;
      s.render.accelerator = scene::Accelerator::kList;
      const std::vector<float> expected = image_of(s, moved, with_hit_layers());
      s.render.accelerator = scene::Accelerator::kEmbree;
      for (const accel::Traversal traversal : {accel::Traversal::kPacket, accel::Traversal::kSingle}) {
        Settings settings = with_hit_layers();
        settings.threads = 3;
        settings.traversal = traversal;
        EXPECT_EQ(image_of(s, moved, settings), expected) << static_cast<int>(precision);
      }
    }
}

/// At each time, a moving rod is the rod whose ends are interpolated.
TEST(RenderRods, MovingRodIsARodAtEachTime) {
  scene::Scene opening = rod_furnace(), closing = opening;
  opening.rods = {rod({-1.2, 0.3, 0}, {1, -0.5, 0.2}, 0.2)};
  closing.rods = {rod({-0.7, -0.2, 0.5}, {1.5, 0.1, -0.3}, 0.4)};
  const compile::CompiledScene moving = compile::compile(opening, &closing);
  for (const double time : {0.0, 0.25, 0.5, 1.0}) {
    // A shutter that is open for an instant.
    compile::CompiledScene at_time = moving;
    scene::Scene still = opening;
    const kernel::Rod now = moving.view().rods.at(0, time);
    still.rods = {rod(math::vector_of(now.a), math::vector_of(now.b), now.radius)};
    const compile::CompiledScene expected = compile::compile(still);
    EXPECT_EQ(expected.rods[0].a[0], now.a[0]);
    // Both ends of the shutter interval at that time: motion of zero, computed by the loops for motion.
    at_time.rods = expected.rods;
    at_time.rod_motion.assign(1, kernel::Rod{{0, 0, 0}, 0, {0, 0, 0}, 0});
    EXPECT_EQ(test::plane_values(render(at_time, with_hit_layers()).picture),
              test::plane_values(render(expected, with_hit_layers()).picture));
  }
}

/// Z, N, P and deep chords of rays through a rod whose hits have closed forms.
TEST(RenderRods, LayersOfFirstHits) {
  scene::Scene s = rod_furnace();
  s.image = {64, 64};
  s.camera.projection = scene::Projection::kOrthographic;
  s.camera.width = 4;
  s.camera.look_from = {0, 0, 10};
  s.render.samples = 1;
  s.rods = {rod({-1, 0, 0}, {1, 0, 0}, 0.5)};
  const auto picture = render(compile::compile(s), with_hit_layers()).picture;
  const auto plane = [&](const std::string& name) -> const std::vector<float>& {
    for (const film::Plane& p : picture.planes)
      if (p.name == name) return p.values;
    ADD_FAILURE() << name;
    return picture.planes[0].values;
  };
  const auto &z = plane("Z"), &nx = plane("N.X"), &ny = plane("N.Y"), &nz = plane("N.Z");
  const auto &px = plane("P.X"), &py = plane("P.Y"), &pz = plane("P.Z");
  int hits = 0, at_ends = 0;
  for (std::size_t i = 0; i < z.size(); ++i) {
    if (z[i] > 100) continue;  // no hit
    ++hits;
    at_ends += std::abs(px[i]) > 1;
    const double x = px[i], y = py[i], beyond = std::max(std::abs(x) - 1, 0.0);
    const double height = std::sqrt(0.25 - y * y - beyond * beyond);
    ASSERT_NEAR(pz[i], height, 1e-5);
    ASSERT_NEAR(z[i], 10 - height, 1e-5);
    ASSERT_NEAR(nx[i], (x < 0 ? -beyond : beyond) / 0.5, 1e-5);
    ASSERT_NEAR(ny[i], y / 0.5, 1e-5);
    ASSERT_NEAR(nz[i], height / 0.5, 1e-5);
  }
  EXPECT_GT(hits, 500);
  EXPECT_GT(at_ends, 50);
}

/// A rod casts a shadow, is lit by a lamp, and emits light: two ways to sample the lights agree.
TEST(RenderRods, LightSamplingAndBsdfSamplingAgree) {
  scene::Scene s = rod_furnace();
  s.background.bottom = s.background.top = {0, 0, 0};
  s.render.samples = 512;
  s.materials.push_back({"lamp", scene::Emitter{{4, 4, 4}}});
  s.spheres = {{{0, 2, 2}, 0.8, 2, ""}, {{0, -100.5, 0}, 100, 0, ""}};
  s.rods = {rod({-1.5, -0.2, 0}, {1, 0.5, 0.2}, 0.25), rod({-1, 1, 1}, {1, 1, 1.2}, 0.1)};
  s.rods[1].materials = {2, 0};
  const auto mean_of = [&](scene::DirectLighting mode) {
    s.render.direct_lighting = mode;
    const auto picture = render(compile::compile(s), {}).picture;
    double sum = 0;
    for (const float v : picture.planes[0].values) sum += static_cast<double>(v);
    return sum / static_cast<double>(picture.planes[0].values.size());
  };
  const double by_bsdf = mean_of(scene::DirectLighting::kBsdf), by_both = mean_of(scene::DirectLighting::kMis),
               by_light = mean_of(scene::DirectLighting::kLight);
  EXPECT_NEAR(by_both / by_bsdf, 1, 0.02);
  EXPECT_NEAR(by_light / by_bsdf, 1, 0.02);
}

}  // namespace
}  // namespace orrery::render
