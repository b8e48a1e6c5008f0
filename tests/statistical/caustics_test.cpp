// SPDX-License-Identifier: Apache-2.0
// Caustics: sampling the images of lights in balls converges to the same image as BSDF sampling.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <vector>

#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "math/vec3.h"
#include "scene/lat_long_map.h"
#include "scene/texture.h"
#include "support/block_means.h"
#include "support/lit_scenes.h"

namespace orrery::test {
namespace {

constexpr int kWidthPx = 32, kHeightPx = 24;

void add_sun(scene::Scene& s, double half_angle) {
  auto map = std::make_shared<scene::LatLongMap>(4, 2);
  for (int y = 0; y < 2; ++y) std::fill_n(map->row(y), 12, y == 0 ? 0.3F : 0.1F);
  map->sun.direction = math::normalized(math::Vec3d{-1, 2, 1});
  map->sun.one_minus_cos = 1 - std::cos(half_angle);
  map->sun.radiance = math::Vec3d{1, 0.9, 0.8} * (1 / map->sun.one_minus_cos);
  s.background.type = scene::BackgroundType::kImage;
  s.background.image = map;
}

/// Balls that form images of lights, in every relation to lights, other balls and the camera. The lights are large, so
/// that BSDF sampling finds them too.
std::vector<NamedScene> caustic_scenes() {
  std::vector<NamedScene> out;
  const scene::Dielectric glass{1.5, scene::Fresnel::kSchlick};
  const scene::Metal mirror{{0.9, 0.8, 0.7}, 0};
  const auto add = [&](const char* name) -> scene::Scene& {
    out.push_back({name, dark_stage(kWidthPx, kHeightPx)});
    out.back().scene.spheres[1].center = {-1.4, 0.8, -0.5};
    return out.back().scene;
  };
  const auto lamp = [](scene::Scene& s) { add_lamp(s, {1.5, 3.5, 1.5}, 1, {10, 9, 8}); };
  scene::Scene& touching = add("balls that touch each other and the floor, and mirrors in glass");
  lamp(touching);
  for (const double x : {0.2, 1.4}) {
    add_ball(touching, {x, 0.6, 0.6}, 0.6, glass);
    add_ball(touching, {x, 0.6, 0.6}, 0.5, mirror);  // light that it reflects through the glass is not sampled
  }
  add_ball(touching, {0.8, 0.4, 1.6}, 0.4, scene::Dielectric{1.3, scene::Fresnel::kExact});
  scene::Scene& blocked = add("blockers inside and outside");
  lamp(blocked);
  add_ball(blocked, {0.6, 0.9, 0.5}, 0.9, glass);
  add_ball(blocked, {0.8, 1.0, 0.6}, 0.3, scene::Lambertian{{0.8, 0.2, 0.2}});
  add_ball(blocked, {1.3, 2.0, 1.2}, 0.25, scene::Lambertian{{0.2, 0.2, 0.8}});
  add_ball(blocked, {0.35, 1.6, 0.85}, 0.35, glass);  // half in the other ball
  scene::Scene& hollow = add("hollow glass beside glass in glass");
  lamp(hollow);
  add_ball(hollow, {1.9, 0.5, 0.8}, 0.5, glass);
  add_ball(hollow, {1.9, 0.5, 0.9}, 0.35, scene::Dielectric{1.4, scene::Fresnel::kExact});
  add_ball(hollow, {0.4, 0.9, 0.5}, 0.9, glass);
  hollow.spheres.push_back({{0.4, 0.9, 0.5}, -0.7, static_cast<std::uint32_t>(hollow.materials.size() - 1)});
  scene::Scene& bubble = add("a ball of lower index, and glass in glass");
  lamp(bubble);
  add_ball(bubble, {1.3, 0.6, 0.8}, 0.6, scene::Dielectric{0.8, scene::Fresnel::kExact});
  add_ball(bubble, {-0.2, 0.6, 1}, 0.6, glass);
  add_ball(bubble, {-0.1, 0.7, 1}, 0.3, scene::Dielectric{1.4, scene::Fresnel::kExact});
  scene::Scene& moving = add("a moving ball and a moving lamp");
  lamp(moving);
  add_ball(moving, {0.2, 0.5, 0.6}, 0.5, glass);
  add_ball(moving, {1.6, 0.5, 0.6}, 0.5, mirror);
  out.back().closing = moving;
  out.back().closing->spheres[2].center = {0.5, 3.2, 1.8};
  out.back().closing->spheres[3].center = {0.9, 1.2, 0.8};
  out.back().closing->spheres[3].radius = 0.7;
  scene::Scene& lamps = add("several lamps");
  lamp(lamps);
  add_lamp(lamps, {-2, 3, 1}, 0.8, {2, 4, 8});
  add_lamp(lamps, {0.6, 0.5, 1.9}, 0.3, {3, 2, 1});
  add_ball(lamps, {0.2, 0.6, 0.6}, 0.6, glass);
  add_ball(lamps, {1.5, 0.6, 0.6}, 0.6, mirror);
  scene::Scene& sun = add("the sun and a lamp");
  lamp(sun);
  add_sun(sun, 0.2);
  add_ball(sun, {0.2, 0.6, 0.6}, 0.6, glass);
  add_ball(sun, {1.5, 0.6, 0.6}, 0.6, mirror);
  scene::Scene& cores = add("objects in glass, also in that of a hollow ball, and a floor that cuts a ball");
  lamp(cores);
  add_sun(cores, 0.2);
  add_ball(cores, {0, 0.7, 0.8}, 0.7, glass);
  add_ball(cores, {0, 0.7, 0.8}, 0.5, scene::Plastic{{0.2, 0.6, 0.3}, 1.5, 0.3});
  add_ball(cores, {1.5, 0.8, 0.6}, 0.8, glass);
  cores.spheres.push_back({{1.5, 0.8, 0.6}, -0.4, static_cast<std::uint32_t>(cores.materials.size() - 1)});
  add_ball(cores, {1.9, 0.95, 1.05}, 0.15, scene::Lambertian{{0.7, 0.5, 0.2}});
  add_ball(cores, {1.4, 0.8, 0.7}, 0.2, scene::Lambertian{{0.2, 0.5, 0.7}});
  add_ball(cores, {-1.2, 0.1, 1.8}, 0.5, scene::Dielectric{1.3, scene::Fresnel::kExact});
  add_ball(cores, {-0.9, 0.7, 0.8}, 0.5, glass);  // cuts another, which its lamp is outside of
  add_lamp(cores, {-1.1, 0.7, 0.8}, 0.15, {9, 6, 3});
  scene::Scene& inside = add("the camera in glass");
  lamp(inside);
  add_ball(inside, {0, 2, 6}, 1, glass);
  add_ball(inside, {0.5, 0.6, 0.6}, 0.6, glass);
  scene::Scene& textured = add("a textured floor, a hemisphere material and a rod");
  lamp(textured);
  auto checker = std::make_shared<scene::Texture>();
  checker->low = {0.1, 0.1, 0.1};
  checker->high = {0.8, 0.8, 0.8};
  textured.materials[0].model = scene::Lambertian{{0.5, 0.5, 0.5}, checker};
  textured.materials[1].model = scene::Hemisphere{{0.6, 0.6, 0.6}};
  add_ball(textured, {0.5, 0.6, 0.6}, 0.6, glass);
  textured.rods.resize(1);
  textured.rods[0].from = {1.4, 0.2, 1.4};
  textured.rods[0].to = {1.4, 1.2, 0.6};
  textured.rods[0].radius = 0.15;
  textured.rods[0].materials = {1, 1};
  scene::Scene& plastic = add("plastic, and objects that some rays do not see");
  lamp(plastic);
  plastic.materials[0].model = scene::Plastic{{0.5, 0.5, 0.5}, 1.5, 0.3};
  plastic.materials[1].model = scene::Lambertian{{0.7, 0.3, 0.2}, {}, 0.5};
  add_ball(plastic, {0.2, 0.6, 0.6}, 0.6, scene::Metal{{0.9, 0.8, 0.7}, 0, {}, {}, 0.7});
  add_ball(plastic, {1.5, 0.6, 0.6}, 0.6, glass);
  return out;
}

compile::CompiledScene sampled(const NamedScene& named, bool caustics, int samples) {
  scene::Scene scene = named.scene;
  scene.render.caustics = caustics;
  if (!caustics) scene.render.direct_lighting = scene::DirectLighting::kBsdf;
  scene.render.samples = samples;
  return compile::compile(scene, named.closing ? &*named.closing : nullptr);
}

/// ORRERY_CAUSTIC_SAMPLES sets the samples per pixel of each of 64 seeds; then |t| < 4 and a standard error of 3e-4 are
/// required.
TEST(StatisticalCaustics, AgreeWithBsdfSampling) {
  int samples = 64, seeds = 16;
  double largest = 5, error = 0.01;
  if (const char* given = std::getenv("ORRERY_CAUSTIC_SAMPLES")) {
    samples = std::atoi(given);
    seeds = 64;
    largest = 4;
    error = 3e-4;
  }
  for (const NamedScene& s : caustic_scenes())
    for (const auto precision : {scene::Precision::kExact, scene::Precision::kFast}) {
      NamedScene in = s;
      in.scene.render.precision = precision;
      if (in.closing) in.closing->render.precision = precision;
      const compile::CompiledScene with = sampled(in, true, samples), without = sampled(in, false, samples);
      ASSERT_TRUE(with.features.caustics) << s.name;
      ASSERT_FALSE(without.features.caustics) << s.name;
      const BlockMeans caustic = block_means(with, seeds), bsdf = block_means(without, seeds);
      EXPECT_LE(caustic.relative_error(), error) << s.name;
      double largest_t = 0;
      for (std::size_t b = 0; b < caustic.mean.size(); ++b) {
        const double t = std::abs(caustic.mean[b] - bsdf.mean[b]) / std::sqrt(caustic.error2[b] + bsdf.error2[b]);
        EXPECT_LT(t, largest) << s.name << ", block " << b << ": " << caustic.mean[b] << " and " << bsdf.mean[b];
        largest_t = std::max(largest_t, t);
      }
      std::printf("%-60s %s: %zu balls, standard error %.1e, bsdf %.1e, largest |t| %.2f\n", s.name.c_str(),
                  precision == scene::Precision::kExact ? "exact" : "fast", with.caustics.balls.size(),
                  caustic.relative_error(), bsdf.relative_error(), largest_t);
      std::fflush(stdout);
    }
}

}  // namespace
}  // namespace orrery::test
