// SPDX-License-Identifier: Apache-2.0
// Layers of whole renders. They do not change the beauty.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <tuple>
#include <utility>

#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "film/layers.h"
#include "film/picture.h"
#include "kernel/isa.h"
#include "render/render.h"
#include "render/result.h"
#include "render/settings.h"
#include "support/add_matte.h"
#include "support/everything.h"
#include "support/lit_scenes.h"

namespace orrery::render {
namespace {

constexpr scene::Filter kEveryFilter[] = {scene::Filter::kBox, scene::Filter::kGaussian,
                                          scene::Filter::kBlackmanHarris};

film::LayerRequest all_layers() {
  film::LayerRequest r;
  r.z = r.depth = r.normal = r.position = r.albedo = true;
  r.diffuse = r.specular = r.transmission = r.background = r.emission = r.light_groups = true;
  r.groups = {{"default", true, true}, {"other", true, false}};
  r.variance = r.samples = r.object_id = r.material_id = r.guide_albedo = r.guide_normal = r.deep = true;
  r.material_numbers.assign(16, 1);
  test::add_matte_of_spheres(r, 0x3f000000u);
  return r;
}

Result render_with(const scene::Scene& scene, const film::LayerRequest& request, int threads = 0) {
  const compile::CompiledScene compiled = compile::compile(scene);
  Settings settings;
  settings.threads = threads;
  settings.layers = request;
  return render(compiled, settings);
}

const std::vector<float>& plane(const Result& result, const char* name) {
  static const std::vector<float> none;
  const film::Plane* found = result.picture.find(name);
  EXPECT_NE(found, nullptr) << name;
  return found != nullptr ? found->values : none;
}

void expect_equal(const Result& a, const Result& b) {
  ASSERT_EQ(a.picture.planes.size(), b.picture.planes.size());
  for (std::size_t i = 0; i < a.picture.planes.size(); ++i)
    EXPECT_EQ(a.picture.planes[i].values, b.picture.planes[i].values) << a.picture.planes[i].name;
}

TEST(RenderLayers, BeautyIsBitIdenticalWithLayers) {
  for (const auto precision : {scene::Precision::kExact, scene::Precision::kFast, scene::Precision::kBook}) {
    for (scene::Scene s : {test::everything(), test::with_lamps(test::with_plastic(test::everything()))}) {
      s.render.precision = precision;
      const Result with = render_with(s, all_layers()), without = render_with(s, {});
      for (const char* name : {"R", "G", "B", "A"}) EXPECT_EQ(plane(with, name), plane(without, name)) << name;
      EXPECT_EQ(with.statistics.rays, without.statistics.rays);
    }
  }
}

TEST(RenderLayers, ThreadsAndAcceleratorsGiveTheSameBits) {
  for (scene::Scene s : {test::everything(), test::translucent(test::everything())}) {
    const Result one = render_with(s, all_layers(), 1);
    expect_equal(render_with(s, all_layers(), 3), one);
    s.render.accelerator = scene::Accelerator::kList;
    expect_equal(render_with(s, all_layers()), one);
  }
}

/// A scene with emitters in two light groups, and a background in the default group.
scene::Scene with_light_groups(scene::Scene s) {
  s.materials.push_back({"key", scene::Emitter{{15, 14, 12}, 0, "key"}});
  s.materials.push_back({"rim", scene::Emitter{{0.1, 0.2, 7}, 0, "rim"}});
  const auto key = static_cast<std::uint32_t>(s.materials.size() - 2);
  s.spheres.push_back({{-0.8, 1.5, -0.5}, 0.4, key, ""});
  s.spheres.push_back({{1, 1.3, -1}, 0.2, key + 1, ""});
  return s;
}

/// The scene with a depth cue that begins in front of its middle.
scene::Scene with_depth_cue(scene::Scene s) {
  s.camera.depth_cue = 0.7;
  s.camera.depth_cue_range = scene::Interval{4, 7};
  return s;
}

TEST(RenderLayers, LobesAndLightGroupsAddUpToTheBeauty) {
  for (const auto precision : {scene::Precision::kExact, scene::Precision::kFast}) {
    for (const scene::Scene& scene : {test::everything(), with_light_groups(test::everything()),
                                      with_light_groups(test::with_plastic(test::everything())),
                                      test::translucent(with_light_groups(test::everything())),
                                      with_depth_cue(with_light_groups(test::everything()))}) {
      scene::Scene s = scene;
      s.render.precision = precision;
      film::LayerRequest request = all_layers();
      request.groups = {{"default", true, true}, {"key", true, true}, {"rim", true, true}};
      const Result r = render_with(s, request);
      for (const char* c : {"R", "G", "B"}) {
        const std::vector<float>& beauty = plane(r, c);
        std::vector<float> lobes(beauty.size()), groups = lobes, products = lobes;
        const auto add = [&](std::vector<float>& sum, const std::string& layer) {
          const auto& values = plane(r, (layer + "." + c).c_str());
          for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += values[i];
        };
        for (const std::string lobe : film::kLobeNames) {
          add(lobes, lobe);
          for (const film::LightGroup& group : request.groups) add(products, group.name + "_" + lobe);
        }
        for (const film::LightGroup& group : request.groups) add(groups, group.name);
        EXPECT_EQ(lobes, beauty) << c;
        EXPECT_EQ(groups, beauty) << c;
        EXPECT_EQ(products, beauty) << c;
      }
      // Light of a group goes to its own layers.
      const bool lit = scene.materials.size() > test::everything().materials.size();
      for (const char* layer : {"key_diffuse_direct.R", "key_emission.R", "rim.B", "emission.G"}) {
        const auto& values = plane(r, layer);
        EXPECT_EQ(std::any_of(values.begin(), values.end(), [](float v) { return v > 0; }), lit) << layer;
      }
      const auto& none = plane(r, "key_background.R");
      EXPECT_EQ(std::count(none.begin(), none.end(), 0.0F), static_cast<std::ptrdiff_t>(none.size()));
    }
  }
}

/// A sphere that fills the image, and another one behind the camera, visible only by reflection or refraction.
scene::Scene ball_before_another(const scene::MaterialModel& first, const scene::MaterialModel& second, int samples) {
  scene::Scene s;
  s.image = {9, 9};
  s.camera.look_from = {0, 0, 5};
  s.camera.look_at = {0, 0, 0};
  s.camera.vfov = 5;
  s.render.samples = samples;
  s.materials = {{"first", first}, {"second", second}};
  s.spheres = {{{0, 0, 0}, 1, 0, ""}, {{0, 0, 30}, 20, 1, ""}};
  return s;
}

/// Two translucent objects in a row, before the background.
TEST(RenderLayers, TranslucentObjectsHaveTheirShareOfAPixel) {
  scene::Scene s;
  s.image = {8, 8};
  s.camera.look_from = {0, 0, 5};
  s.camera.look_at = {0, 0, 0};
  s.camera.vfov = 1;
  s.render.samples = 4096;
  s.materials = {{"front", scene::Lambertian{{0.5, 0.5, 0.5}, {}, 0.25}},
                 {"back", scene::Metal{{0.5, 0.5, 0.5}, 0, {}, {}, 0.6}}};
  s.spheres = {{{0, 0, 0}, 1, 0, ""}, {{0, 0, -3}, 1, 1, ""}};
  film::LayerRequest request = all_layers();
  request.coverage = request.transparent = true;
  const Result r = render_with(s, request);
  // Binomial: |z| of the mean of a plane over the image.
  const auto expect_share = [&](const std::string& name, double share) {
    double mean = 0;
    for (const float v : plane(r, name.c_str())) mean += static_cast<double>(v) / 64;
    const double z = (mean - share) / std::sqrt(share * (1 - share) / (64.0 * 4096));
    EXPECT_LT(std::abs(z), 4) << name << " is " << mean;
  };
  // The object in front is there only where the one behind is.
  expect_share("A", 0.6);
  // A pixel's mattes are in descending order of their share.
  expect_share("CryptoObject00.G", 0.35);
  expect_share("CryptoObject00.A", 0.25);
  for (std::size_t i = 0; i < 64; ++i) EXPECT_NEAR(plane(r, "Z")[i], 4, 1e-3) << "of the nearest hit";
}

/// With a single material, only that material's groups receive light.
TEST(RenderLayers, LightIsInTheGroupOfTheFirstSurface) {
  const auto groups_of = [](scene::MaterialModel model) {
    scene::Scene s;
    s.image = {32, 32};
    s.camera.look_from = {0, 0, 4};
    s.camera.look_at = {0, 0, 0};
    s.camera.vfov = 40;
    s.render.samples = 8;
    s.materials = {{"one", model}};
    s.spheres = {{{0, 0, 0}, 1, 0, ""}};
    const Result r = render_with(s, all_layers());
    std::string out;
    for (const char* group : {"background", "diffuse_direct", "diffuse_indirect", "specular_direct",
                              "specular_indirect", "transmission_direct", "transmission_indirect"})
      for (const float v : plane(r, (std::string(group) + ".G").c_str()))
        if (v > 0) {
          out += std::string(group) + " ";
          break;
        }
    return out;
  };
  EXPECT_EQ(groups_of(scene::Lambertian{{0.5, 0.5, 0.5}}), "background diffuse_direct ");
  EXPECT_EQ(groups_of(scene::Metal{{0.5, 0.5, 0.5}, 0}), "background specular_direct ");
  for (const double fuzz : {0.0, 0.3})
    EXPECT_EQ(groups_of(scene::Plastic{{0.5, 0.5, 0.5}, 1.5, fuzz}), "background diffuse_direct specular_direct ");
  // Light transmitted through both interfaces is direct; light reflected inside is indirect.
  EXPECT_EQ(groups_of(scene::Dielectric{1.5, scene::Fresnel::kExact}),
            "background specular_direct transmission_direct transmission_indirect ");
}

/// Later surfaces do not change the lobe.
TEST(RenderLayers, FirstSurfaceDeterminesTheGroup) {
  const scene::MaterialModel mirror = scene::Metal{{0.9, 0.9, 0.9}, 0}, clay = scene::Lambertian{{0.5, 0.5, 0.5}},
                             glass = scene::Dielectric{1.5, scene::Fresnel::kExact};
  const std::tuple<scene::MaterialModel, scene::MaterialModel, std::string> cases[] = {
      {mirror, clay, "specular"}, {clay, mirror, "diffuse"}, {clay, glass, "diffuse"}};
  for (const auto& [first, second, group] : cases) {
    const Result r = render_with(ball_before_another(first, second, 64), all_layers());
    double indirect = 0;
    for (std::size_t i = 0; i < 81; ++i) {
      EXPECT_EQ(plane(r, (group + "_direct.G").c_str())[i] + plane(r, (group + "_indirect.G").c_str())[i],
                plane(r, "G")[i]);
      indirect += static_cast<double>(plane(r, (group + "_indirect.G").c_str())[i]);
    }
    EXPECT_GT(indirect, 0.1) << group;
  }
}

TEST(RenderLayers, DepthNormalAndPositionMatchTheSphere) {
  scene::Scene s;
  s.image = {33, 33};
  s.camera.look_from = {0, 0, 5};
  s.camera.look_at = {0, 0, 0};
  s.camera.vfov = 30;
  s.render.samples = 4;
  s.materials = {{"one", scene::Lambertian{{0.5, 0.25, 0.125}}}};
  s.spheres = {{{0, 0, 0}, 1, 0, ""}};
  const Result r = render_with(s, all_layers());
  int inside = 0;
  for (std::size_t i = 0; i < plane(r, "Z").size(); ++i) {
    if (plane(r, "object_id.X")[i] == 0) {
      EXPECT_EQ(plane(r, "Z")[i], film::kNothingHit);
      continue;
    }
    const double x = plane(r, "P.X")[i], y = plane(r, "P.Y")[i], z = plane(r, "P.Z")[i];
    EXPECT_NEAR(std::sqrt(x * x + y * y + z * z), 1, 1e-6);
    EXPECT_NEAR(plane(r, "Z")[i], 5 - z, 1e-6);
    EXPECT_NEAR(plane(r, "depth.X")[i], std::sqrt(x * x + y * y + (5 - z) * (5 - z)), 1e-6);
    if (plane(r, "CryptoObject00.G")[i] < 1) continue;  // an edge
    ++inside;
    EXPECT_NEAR(plane(r, "N.X")[i], x, 0.1);  // mean over the pixel compared with one point in it
    EXPECT_EQ(plane(r, "albedo.R")[i], 0.5F);
    EXPECT_EQ(plane(r, "denoise.albedo.G")[i], 0.25F);
    EXPECT_FLOAT_EQ(plane(r, "denoise.normal.Z")[i], plane(r, "N.Z")[i]);
  }
  EXPECT_GT(inside, 300);
}

/// A sphere seen along its axis, from any distance, is a disc; depths are measured from the camera's plane.
TEST(RenderLayers, OrthographicDepthsAreMeasuredAlongTheView) {
  for (const double distance : {2.0, 5.0, 1e6}) {
    scene::Scene s;
    s.image = {32, 16};
    s.camera.projection = scene::Projection::kOrthographic;
    s.camera.width = 8;
    s.camera.look_from = {0, 0, distance};
    s.camera.look_at = {0, 0, 0};
    s.render.samples = 16;
    s.materials = {{"one", scene::Lambertian{{0.5, 0.25, 0.125}}}};
    s.spheres = {{{1, 0, 0}, 1, 0, ""}};
    const Result r = render_with(s, all_layers());
    double covered = 0;
    for (std::size_t i = 0; i < plane(r, "Z").size(); ++i) {
      covered += static_cast<double>(plane(r, "CryptoObject00.G")[i]);
      if (plane(r, "object_id.X")[i] == 0) continue;
      EXPECT_EQ(plane(r, "Z")[i], plane(r, "depth.X")[i]);
      EXPECT_NEAR(static_cast<double>(plane(r, "Z")[i]) / (distance - plane(r, "P.Z")[i]), 1, 1e-6);
    }
    EXPECT_NEAR(covered, std::numbers::pi * 16, 0.5) << "four pixels per unit; at " << distance;
  }
}

/// The lens extends into a sphere, so paths of one pixel hit its surface from both sides. Each path's normal faces its
/// own ray.
TEST(RenderLayers, NormalsFaceEachRayOfALensInsideASphere) {
  scene::Scene s;
  s.image = {16, 16};
  s.camera.look_from = {0, 0, 3};
  s.camera.look_at = {0, 0, 0};
  s.camera.vfov = 20;
  s.camera.focus_distance = 3;
  s.camera.defocus_angle = 90;  // a lens of radius 3
  s.render.samples = 64;
  s.materials = {{"one", scene::Lambertian{{0.5, 0.5, 0.5}}}};
  s.spheres = {{{0, 0, 3}, 2, 0, ""}};  // contains the lens's centre but not its rim
  // The kernel computes the guide normal at the hit, from the ray.
  const Result r = render_with(s, all_layers());
  for (const char* axis : {"X", "Y", "Z"})
    for (std::size_t i = 0; i < 256; ++i)
      EXPECT_NEAR(plane(r, (std::string("N.") + axis).c_str())[i],
                  plane(r, (std::string("denoise.normal.") + axis).c_str())[i], 1e-6F);
}

/// Denoiser guides show the surface that a mirror reflects.
TEST(RenderLayers, GuidesFollowMirrorsToTheFirstDiffuseSurface) {
  const Result r = render_with(
      ball_before_another(scene::Metal{{0.5, 0.5, 0.5}, 0}, scene::Lambertian{{0.8, 0.4, 0.2}}, 4), all_layers());
  EXPECT_FLOAT_EQ(plane(r, "denoise.albedo.R")[40], 0.4F);
  EXPECT_FLOAT_EQ(plane(r, "denoise.albedo.B")[40], 0.1F);
  EXPECT_NEAR(plane(r, "denoise.normal.Z")[40], -1, 1e-3);
  EXPECT_FLOAT_EQ(plane(r, "albedo.R")[40], 0.5F);  // the mirror's albedo
}

/// Even if the coat is a mirror: what it reflects is a small part of the light.
TEST(RenderLayers, GuidesShowTheSurfaceOfPlastic) {
  for (const double fuzz : {0.0, 0.3}) {
    const Result r =
        render_with(ball_before_another(scene::Plastic{{0.5, 0.25, 0.125}, 2.5, fuzz}, scene::Metal{{1, 1, 1}, 0}, 64),
                    all_layers());
    EXPECT_EQ(plane(r, "denoise.albedo.R")[40], 0.5F);
    EXPECT_EQ(plane(r, "denoise.albedo.B")[40], 0.125F);
    EXPECT_NEAR(plane(r, "denoise.normal.Z")[40], 1, 1e-3);
    EXPECT_EQ(plane(r, "albedo.R")[40], 0.5F);
  }
}

/// A lamp of a small solid angle, straight ahead: the light that each lobe reflects is the product of its density, the
/// solid angle and the radiance.
TEST(RenderLayers, CoatIsSpecularAndBaseIsDiffuse) {
  constexpr double kFuzz = 0.4, kShare = 0.04, pi = std::numbers::pi, kSolidAngle = pi * 1e-4, kRadiance = 1e4;
  for (const auto mode : {scene::DirectLighting::kMis, scene::DirectLighting::kLight}) {
    scene::Scene s = ball_before_another(scene::Plastic{{0.5, 0.5, 0.5}, 1.5, kFuzz},
                                         scene::Emitter{{kRadiance, kRadiance, kRadiance}}, 4096);
    s.image = {1, 1};
    s.camera.vfov = 1e-3;
    s.spheres[1].center = {0, 0, 101};
    s.spheres[1].radius = 1;
    s.background.type = scene::BackgroundType::kConstant;
    s.background.color = {0, 0, 0};
    s.render.direct_lighting = mode;
    const Result r = render_with(s, all_layers());
    const double coat = kShare * 2 / (pi * 5 * kFuzz * kFuzz / 3), base = (1 - kShare) * 0.5 / pi;
    EXPECT_NEAR(plane(r, "specular_direct.G")[0] / (coat * kSolidAngle * kRadiance), 1, 0.01);
    EXPECT_NEAR(plane(r, "diffuse_direct.G")[0] / (base * kSolidAngle * kRadiance), 1, 0.01);
    EXPECT_EQ(plane(r, "specular_indirect.G")[0] + plane(r, "diffuse_indirect.G")[0], 0);
    // A smooth coat reflects the image of the lamp, which only BSDF sampling finds.
    s.materials[0].model = scene::Plastic{{0.5, 0.5, 0.5}, 1.5, 0};
    EXPECT_NEAR(plane(render_with(s, all_layers()), "specular_direct.G")[0] / (kShare * kRadiance), 1, 0.01);
  }
}

/// Compositing the image over a constant sky by the sum of its mattes, which equals alpha, gives the image rendered
/// with that sky: no halo.
TEST(RenderLayers, TransparentBackgroundLeavesNoHaloAtADefocusedEdge) {
  for (const scene::Filter filter : kEveryFilter) {
    scene::Scene s = test::everything();
    s.render.samples = 64;
    s.render.filter = filter;
    s.background.type = scene::BackgroundType::kConstant;
    s.background.color = {0.25, 0.5, 0.75};
    const Result opaque = render_with(s, {});
    film::LayerRequest cut_out;
    cut_out.coverage = cut_out.transparent = true;
    test::add_matte_of_spheres(cut_out, 0x3f000000u);
    const Result empty = render_with(s, cut_out);
    double worst = 0;
    int edges = 0;
    for (std::size_t i = 0; i < plane(empty, "A").size(); ++i) {
      const double alpha = plane(empty, "A")[i];
      edges += alpha > 0 && alpha < 1 ? 1 : 0;
      double matte = 0;  // sum over all objects in the pixel
      for (const char* rank : {"00.G", "00.A", "01.G", "01.A", "02.G", "02.A"})
        matte += static_cast<double>(plane(empty, (std::string("CryptoObject") + rank).c_str())[i]);
      EXPECT_EQ(matte, alpha) << "shares of 64 samples are exact";
      const double over = plane(empty, "R")[i] + (1 - matte) * 0.25;
      worst = std::max(worst, std::abs(over - plane(opaque, "R")[i]));
    }
    EXPECT_GT(edges, 20);
    EXPECT_LT(worst, 1e-6);
  }
}

/// Camera rays see the backdrop; all other light is that of the background.
TEST(RenderLayers, ABackdropIlluminatesNothing) {
  scene::Scene s = test::everything();
  s.render.samples = 64;
  film::LayerRequest cut_out;
  cut_out.coverage = cut_out.transparent = true;
  const Result empty = render_with(s, cut_out);
  s.background.backdrop = {0.25, 0.5, 0.75};
  const Result seen = render_with(s, {});
  double worst = 0;
  int edges = 0;
  for (std::size_t i = 0; i < plane(empty, "A").size(); ++i) {
    const double uncovered = 1 - plane(empty, "A")[i];
    edges += uncovered > 0 && uncovered < 1 ? 1 : 0;
    worst = std::max(worst, std::abs(plane(empty, "R")[i] + uncovered * 0.25 - plane(seen, "R")[i]));
    worst = std::max(worst, std::abs(plane(empty, "B")[i] + uncovered * 0.75 - plane(seen, "B")[i]));
  }
  EXPECT_GT(edges, 20);
  EXPECT_LT(worst, 1e-5);
  EXPECT_EQ(plane(render_with(s, cut_out), "R"), plane(empty, "R")) << "a transparent background has none";
}

/// Spheres of radius 0.5 side by side, at depths of 4.5, 6, 8, and 14.5 of an orthographic camera, without lighting.
scene::Scene row_in_depth() {
  scene::Scene s;
  s.image = {401, 101};
  s.camera.projection = scene::Projection::kOrthographic;
  s.camera.width = 8;
  s.camera.look_from = {0, 0, 10};
  s.camera.look_at = {0, 0, 0};
  s.camera.depth_cue = 0.5;
  s.camera.depth_cue_range = scene::Interval{5, 13};
  s.background.backdrop = {1, 0.5, 0.25};
  s.render.shading = scene::Shading::kFlat;
  s.render.samples = 4;
  s.materials = {{"blue", scene::Lambertian{{0.1, 0.2, 0.8}}}};
  double x = -3;
  for (const double depth : {4.5, 6.0, 8.0, 14.5}) {
    s.spheres.push_back({{x, 0, 10 - depth - 0.5}, 0.5});
    x += 2;
  }
  return s;
}

TEST(RenderLayers, ADepthCueIsLinearInTheDepthOfTheFirstHit) {
  const scene::Scene s = row_in_depth();
  const double shares[] = {0, 0.0625, 0.1875, 0.5};
  film::LayerRequest cut_out;
  cut_out.coverage = cut_out.transparent = true;
  for (const auto precision : {scene::Precision::kExact, scene::Precision::kFast}) {
    scene::Scene with_precision = s;
    with_precision.render.precision = precision;
    const Result seen = render_with(with_precision, {}), transparent = render_with(with_precision, cut_out);
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t pixel = 50 * 401 + 50 + i * 100;
      EXPECT_NEAR(plane(seen, "R")[pixel], 0.1 * (1 - shares[i]) + shares[i], 1e-4) << i;
      EXPECT_NEAR(plane(seen, "B")[pixel], 0.8 * (1 - shares[i]) + 0.25 * shares[i], 1e-4) << i;
      EXPECT_NEAR(plane(transparent, "B")[pixel], 0.8 * (1 - shares[i]), 1e-4) << i;
      EXPECT_NEAR(plane(transparent, "A")[pixel], 1 - shares[i], 1e-4) << i;
    }
    EXPECT_EQ(plane(seen, "R")[50 * 401 + 50], 0.1F) << "exact in front";
    EXPECT_EQ(plane(transparent, "A")[0], 0);
  }
}

/// A ball on a page under a small lamp: the page has the colour of the backdrop except in the shadow.
TEST(RenderLayers, APageIsTheBackdropExceptForShadows) {
  scene::Scene s;
  s.image = {60, 60};
  s.camera.projection = scene::Projection::kOrthographic;
  s.camera.width = 8;
  s.camera.look_from = {0, 10, 0.1};
  s.camera.look_at = {0, 0, 0};
  s.background.type = scene::BackgroundType::kConstant;
  s.background.color = {0, 0, 0};
  s.background.backdrop = {0.5, 0.5, 0.5};
  s.render.samples = 64;
  // The irradiance of the lamp, which is far away, is pi times 10,000 (100 / 10,000)^2, at 45 degrees.
  const double albedo = 0.5 * std::sqrt(2);
  s.materials = {{"page", scene::Lambertian{{albedo, albedo, albedo}}},
                 {"lamp", scene::Emitter{{10000, 10000, 10000}}},
                 {"ball", scene::Lambertian{{0, 0, 0}}}};
  s.spheres = {{{0, -1e6, 0}, 1e6, 0}, {{7071, 7071, 0}, 100, 1}, {{0, 1, 0}, 1, 2}};
  s.spheres[0].is_page = true;
  film::LayerRequest request;
  request.coverage = true;
  const auto at = [](double x, double z) {
    return static_cast<std::size_t>(30 + z * 7.5) * 60 + static_cast<std::size_t>(30 + x * 7.5);
  };
  const Result seen = render_with(s, request);
  EXPECT_NEAR(plane(seen, "R")[at(2, 2)], 0.5, 2e-3);
  EXPECT_LT(plane(seen, "R")[at(-1.5, 0)], 0.01) << "in the shadow";
  EXPECT_EQ(seen.picture.coverage[at(-1.5, 0)], 0) << "a page does not cover";
  EXPECT_EQ(seen.picture.coverage[at(0, 0)], 1);
  request.transparent = true;
  const Result transparent = render_with(s, request);
  EXPECT_NEAR(plane(transparent, "A")[at(2, 2)], 0, 5e-3);
  EXPECT_NEAR(plane(transparent, "A")[at(-1.5, 0)], 1, 0.02);
  EXPECT_EQ(plane(transparent, "R")[at(-1.5, 0)], 0);
  s.camera.projection = scene::Projection::kPerspective;
  s.camera.look_from = {0, 3, 30};
  s.camera.vfov = 8;
  EXPECT_NEAR(plane(render_with(s, request), "A")[30], 0, 5e-3) << "far behind the ball";
}

TEST(RenderLayers, DeepSamplesFlattenToTheBeautyWithEveryFilter) {
  film::LayerRequest cut_out = all_layers();
  cut_out.coverage = cut_out.transparent = true;
  for (const scene::Filter filter : kEveryFilter)
    for (const film::LayerRequest& request : {all_layers(), cut_out}) {
      scene::Scene s = test::everything();
      s.render.filter = filter;
      const Result r = render_with(s, request);
      for (std::size_t i = 0; i < r.deep.pixels.size(); ++i) {
        double color = 0, through = 1;
        float last = 0;
        for (const film::DeepSample& sample : r.deep.pixels[i]) {
          EXPECT_LE(last, sample.front);
          EXPECT_LE(sample.front, sample.back);
          last = sample.front;
          color += static_cast<double>(sample.rgb[0]) * through;
          through *= 1 - static_cast<double>(sample.alpha);
        }
        EXPECT_NEAR(color, static_cast<double>(plane(r, "R")[i]), 1e-6) << i;
        EXPECT_NEAR(1 - through, static_cast<double>(plane(r, "A")[i]), 1e-6) << i;
      }
    }
}

/// Many samples are rendered in several passes; none may be lost.
TEST(RenderLayers, SamplesOfAllPassesAreCounted) {
  scene::Scene s = test::everything();
  s.image = {4, 4};
  s.render.samples = 10000;
  const Result r = render_with(s, all_layers());
  for (const float n : plane(r, "samples.X")) EXPECT_EQ(n, 10000);
}

TEST(RenderLayers, VarianceMatchesTheVarianceOverSeeds) {
  for (const auto filter : {scene::Filter::kBox, scene::Filter::kGaussian}) {
    scene::Scene s = test::everything();
    s.render.filter = filter;
    s.image = {12, 8};
    s.render.samples = 64;
    s.render.sampler = scene::Sampler::kIndependent;  // for the other samplers the variance layer is an upper bound
    constexpr int kSeeds = 40;
    std::vector<double> sum(96), squares(96), forecast(96);
    for (int seed = 0; seed < kSeeds; ++seed) {
      s.render.seed = static_cast<std::uint32_t>(seed);
      const Result r = render_with(s, all_layers());
      for (std::size_t i = 0; i < sum.size(); ++i) {
        const double v = plane(r, "G")[i];
        sum[i] += v;
        squares[i] += v * v;
        forecast[i] += plane(r, "variance.G")[i] / kSeeds;
      }
    }
    double seen = 0, told = 0;
    for (std::size_t i = 0; i < sum.size(); ++i) {
      seen += (squares[i] - sum[i] * sum[i] / kSeeds) / (kSeeds - 1);
      told += forecast[i];
    }
    // 96 pixels with 39 degrees of freedom: a standard error of about 3 %.
    EXPECT_NEAR(seen / told, 1, 0.1) << static_cast<int>(filter);
  }
}

/// Pixel filters preserve a constant image.
TEST(RenderFilter, ConstantSkyIsConstantUnderEveryFilter) {
  using enum scene::Filter;
  for (const auto filter : kEveryFilter) {
    scene::Scene s;
    s.image = {5, 4};
    s.background.type = scene::BackgroundType::kConstant;
    s.background.color = {0.3, 0.6, 0.9};
    s.render.filter = filter;
    for (const int samples : {1, 2, 17, 100}) {
      s.render.samples = samples;
      film::LayerRequest request;
      request.variance = true;
      const Result r = render_with(s, request);
      for (const auto& [name, light] : {std::pair{"R", 0.3F}, {"G", 0.6F}, {"B", 0.9F}}) {
        for (const float v : plane(r, name)) EXPECT_FLOAT_EQ(v, light) << name << ", samples " << samples;
        for (const float v : plane(r, (std::string("variance.") + name).c_str())) EXPECT_EQ(v, 0) << samples;
      }
    }
  }
}

/// The silhouette of a huge sphere is a straight edge. Coverage across it is the integral of the filter.
TEST(RenderFilter, EdgeCoverageIsTheFilterIntegral) {
  using enum scene::Filter;
  for (const auto& [filter, width] : {std::pair{kBox, 1.0}, {kBox, 2.0}, {kGaussian, 3.0}}) {
    scene::Scene s;
    s.image = {8, 1};
    s.camera.look_from = {0, 0, 0};
    s.camera.look_at = {0, 0, -1};
    s.camera.vfov = 0.02;
    // Its silhouette is vertical at the image centre, on the camera axis.
    s.materials = {{"one", scene::Lambertian{}}};
    s.spheres = {{{-1e6, 0, -1e6}, 1e6, 0, ""}};
    s.render.samples = 1 << 16;
    s.render.filter = filter;
    s.render.filter_width = width;
    film::LayerRequest request;
    request.coverage = request.transparent = true;
    const Result r = render_with(s, request);
    // The same integral by numerical quadrature of the filter formulas.
    const auto f = [filter = filter, width = width](double x) {
      const double t = std::abs(x);
      if (t > width / 2) return 0.0;
      if (filter == kGaussian) return std::exp(-18 * x * x / (width * width));
      return 1.0;
    };
    for (int x = 0; x < 8; ++x) {
      double below = 0, all = 0;
      for (double at = -2.5 + 0.0005; at < 2.5; at += 0.001) {
        all += f(at);
        below += x + 0.5 + at < 4 ? f(at) : 0;
      }
      EXPECT_NEAR(plane(r, "A")[static_cast<std::size_t>(x)], below / all, 0.01)
          << "pixel " << x << " of filter " << static_cast<int>(filter);
    }
  }
}

TEST(RenderWindow, CropIsBitIdenticalToTheFullImage) {
  scene::Scene s = test::everything();
  const Result whole = render_with(s, all_layers());
  s.image.crop = scene::Window{20, 9, 31, 17};
  const Result part = render_with(s, all_layers());
  EXPECT_EQ(part.picture.x, 20);
  EXPECT_EQ(part.picture.width, 31);
  EXPECT_EQ(part.picture.frame_width, 61);
  for (const film::Plane& p : part.picture.planes)
    for (int y = 0; y < 17; ++y)
      for (int x = 0; x < 31; ++x)
        ASSERT_EQ(p.values[static_cast<std::size_t>(y * 31 + x)],
                  plane(whole, p.name.c_str())[static_cast<std::size_t>((y + 9) * 61 + x + 20)])
            << p.name << " at " << x << ", " << y;
}

TEST(RenderWindow, OverscanDoesNotChangeTheFrame) {
  scene::Scene s = test::everything();
  const Result frame = render_with(s, {});
  s.image.overscan = 5;
  const Result wide = render_with(s, {});
  EXPECT_EQ(wide.picture.x, -5);
  EXPECT_EQ(wide.picture.width, 71);
  for (int y = 0; y < 37; ++y)
    for (int x = 0; x < 61; ++x)
      ASSERT_EQ(plane(wide, "G")[static_cast<std::size_t>((y + 5) * 71 + x + 5)],
                plane(frame, "G")[static_cast<std::size_t>(y * 61 + x)])
          << x << ", " << y;
}

TEST(RenderWindow, PixelAspectStretchesPixels) {
  scene::Scene s = test::everything();
  s.image = {20, 20};
  s.camera.defocus_angle = 0;
  s.image.pixel_aspect = 2;
  const compile::CompiledScene compiled = compile::compile(s);
  EXPECT_NEAR(length(compiled.camera.right) / length(compiled.camera.down), 2, 1e-12);
}

/// The halves have different samples, and their mean is the beauty.
TEST(RenderLayers, HalvesAverageToTheBeauty) {
  scene::Scene s = test::everything();
  s.image = {32, 18};
  s.render.samples = 16;
  film::LayerRequest request;
  request.halves = true;
  const compile::CompiledScene compiled = compile::compile(s);
  for (const bool is_adaptive : {false, true}) {
    Settings settings;
    settings.layers = request;
    if (is_adaptive) settings.noise = 0.2;
    const Result with = render(compiled, settings);
    settings.layers = {};
    if (!is_adaptive) {  // with a target, an image without halves has more samples
      EXPECT_EQ(render(compiled, settings).picture.planes[1].values, with.picture.planes[1].values)
          << "the layer does not change the beauty";
    }
    int different = 0;
    for (std::size_t i = 0; i < with.picture.planes[0].values.size(); ++i) {
      const float a = plane(with, "half_a.G")[i], b = plane(with, "half_b.G")[i];
      EXPECT_NEAR((a + b) / 2, plane(with, "G")[i], 1e-5F + 1e-4F * std::abs(a - b));
      different += a != b ? 1 : 0;
    }
    EXPECT_GT(different, 100);
  }
}

}  // namespace
}  // namespace orrery::render
