// SPDX-License-Identifier: Apache-2.0
// The lit path loop: bit for bit the same where nothing emits, closed forms where something does.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <numbers>
#include <vector>

#include "accel/accel.h"
#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "film/layer_sums.h"
#include "film/layers.h"
#include "render/tiles.h"
#include "support/everything.h"

namespace orrery::render {
namespace {

/// All that one tile, the whole picture, has given.
struct Rendered {
  std::vector<kernel::PixelSum> sums;
  std::vector<kernel::PathRecord> records;
  std::vector<kernel::GuideSum> guides;
  LightEventBuffer events;
  kernel::TileCounts counts;

  std::vector<kernel::LightEvent> all_events() const {
    return {events.begin(), const_cast<const kernel::LightEvent*>(events.next)};
  }
};

enum class Kind { kPlain, kLit };

void render_tile(const compile::CompiledScene& compiled, kernel::SceneView view, Kind kind, bool records,
                 Rendered& out) {
  view.features.lit = kind == Kind::kLit;
  const auto accel = accel::make_embree(compiled.view(), compiled.precision);
  out.sums.assign(static_cast<std::size_t>(compiled.width * compiled.height), {});
  kernel::Tile tile;
  tile.width = compiled.width;
  tile.height = compiled.height;
  tile.sample_end = static_cast<std::uint32_t>(compiled.samples);
  tile.sums = out.sums.data();
  tile.row_stride = compiled.width;
  if (records) {
    out.records.resize(tile.path_count());
    out.events.reset(tile.path_count());
    tile.records = out.records.data();
    out.guides.resize(out.sums.size());
    tile.guides = out.guides.data();
    tile.events = &out.events;
  }
  const auto loop = kernel::render_tile_function(view.features, compiled.precision, records);
  out.counts = loop(view, accel->tracer(), tile, *std::make_unique<kernel::PathStream>());
}

bool equal(const double (&a)[3], const double (&b)[3]) { return a[0] == b[0] && a[1] == b[1] && a[2] == b[2]; }

void expect_same_beauty(const Rendered& a, const Rendered& b) {
  EXPECT_EQ(a.counts.rays, b.counts.rays);
  EXPECT_EQ(a.counts.bad_samples, b.counts.bad_samples);
  int different = 0;
  for (std::size_t i = 0; i < a.sums.size(); ++i) {
    different += a.sums[i].weight != b.sums[i].weight;
    for (int c = 0; c < 3; ++c) different += a.sums[i].rgb[c] != b.sums[i].rgb[c];
  }
  EXPECT_EQ(different, 0);
}

void expect_same(const Rendered& a, const Rendered& b) {
  expect_same_beauty(a, b);
  int different = 0;
  for (std::size_t i = 0; i < a.records.size(); ++i) {
    const kernel::PathRecord &x = a.records[i], &y = b.records[i];
    different += !equal(x.light, y.light) || !(x.offset == y.offset) || !(x.direction == y.direction);
    different += x.object != y.object;
  }
  for (std::size_t i = 0; i < a.guides.size(); ++i) {
    const kernel::GuideSum &x = a.guides[i], &y = b.guides[i];
    different += x.inverse_depth != y.inverse_depth || x.weight != y.weight;
    for (int k = 0; k < 3; ++k) different += x.albedo[k] != y.albedo[k] || x.normal[k] != y.normal[k];
  }
  const auto p = a.all_events(), q = b.all_events();
  ASSERT_EQ(p.size(), q.size());
  for (std::size_t i = 0; i < p.size(); ++i)
    different += !equal(p[i].value, q[i].value) || p[i].path != q[i].path || p[i].lobe != q[i].lobe;
  EXPECT_EQ(different, 0);
}

TEST(RenderLitLoop, SameBitsWhereNothingEmits) {
  for (const auto precision : {scene::Precision::kExact, scene::Precision::kFast}) {
    for (const auto shading : {scene::Shading::kPath, scene::Shading::kNormal}) {
      for (const bool background_visible : {true, false}) {
        for (const bool records : {false, true}) {
          scene::Scene scene = test::everything();
          scene.image = {48, 27};
          scene.render.samples = 16;
          scene.render.max_depth = 6;
          scene.render.roulette_depth = 2;
          scene.render.precision = precision;
          scene.render.shading = shading;
          const compile::CompiledScene compiled = compile::compile(scene);
          kernel::SceneView view = compiled.view();
          view.background_visible = background_visible;
          view.has_backdrop = records;
          view.backdrop = {0.25, 0.5, 0.75};
          Rendered plain, unlit, lit;
          render_tile(compiled, view, Kind::kPlain, false, plain);
          render_tile(compiled, view, Kind::kPlain, records, unlit);
          render_tile(compiled, view, Kind::kLit, records, lit);
          expect_same_beauty(plain, unlit);
          expect_same(unlit, lit);
          EXPECT_GT(plain.counts.rays, plain.sums.size());
        }
      }
    }
  }
}

/// The camera in a grey hollow sphere that emits.
struct Furnace {
  compile::CompiledScene compiled;
  std::vector<kernel::Emission> emission;
  kernel::SceneView view;

  Furnace(scene::Precision precision, int max_depth, double emitted,
          const scene::MaterialModel& grey = scene::Lambertian{{0.5, 0.25, 0.5}}) {
    scene::Scene s;
    s.image = {8, 4};
    s.camera.look_from = {0, 0, 0};
    s.camera.look_at = {0, 0, -1};
    s.camera.vfov = 60;
    s.background.bottom = s.background.top = {1e30, 1e30, 1e30};  // never seen
    s.materials = {{"grey", grey}};
    s.spheres = {{{0, 0, 0}, 10, 0, ""}};
    s.render.samples = 16;
    s.render.max_depth = max_depth;
    s.render.roulette_depth = 0;
    s.render.precision = precision;
    compiled = compile::compile(s);
    emission.resize(compiled.materials.size());
    for (kernel::Emission& e : emission) e.radiance[0] = e.radiance[1] = e.radiance[2] = emitted;
    view = compiled.view();
    view.emission = emission.data();
  }
};

TEST(RenderLitLoop, AFurnaceHasItsSeries) {
  for (const auto precision : {scene::Precision::kExact, scene::Precision::kFast}) {
    for (const int rays : {1, 2, 3, 20}) {
      const Furnace furnace(precision, rays, 4);
      for (const bool records : {false, true}) {
        Rendered out;
        render_tile(furnace.compiled, furnace.view, Kind::kLit, records, out);
        EXPECT_EQ(out.counts.bad_samples, 0u);
        // Powers of two: exact in either precision.
        const double red = 8 - std::ldexp(8, -rays);
        for (const kernel::PixelSum& sum : out.sums) {
          ASSERT_EQ(sum.weight, 16);
          ASSERT_EQ(kernel::from_fixed_point(sum.rgb[0]), 16 * red) << rays;
        }
        if (!records) continue;
        std::vector<double> of_path(out.records.size());
        for (const kernel::LightEvent& e : out.all_events()) {
          of_path[e.path] += e.value[0];
          const int bounces = -std::ilogb(e.value[0] / 4);
          ASSERT_EQ(e.lobe, bounces == 0   ? kernel::Lobe::kEmission
                            : bounces == 1 ? kernel::Lobe::kDiffuseDirect
                                           : kernel::Lobe::kDiffuseIndirect);
        }
        EXPECT_EQ(out.all_events().size(), out.records.size() * static_cast<std::size_t>(rays));
        for (std::size_t i = 0; i < of_path.size(); ++i) {
          ASSERT_EQ(of_path[i], red);
          ASSERT_EQ(out.records[i].light[0], red);
        }
      }
    }
  }
}

/// A grey ball in an emissive shell, seen from within the shell.
scene::Scene ball_in_a_shell(double albedo, scene::DirectLighting mode) {
  scene::Scene s;
  s.image = {32, 32};
  s.background.type = scene::BackgroundType::kConstant;
  s.background.color = {1e30, 1e30, 1e30};  // never seen
  s.camera.look_from = {0, 0, 4};
  s.camera.look_at = {0, 0, 0};
  s.camera.vfov = 60;
  s.materials = {{"grey", scene::Lambertian{{albedo, albedo, albedo}}}, {"shell", scene::Emitter{{3, 2, 1}, 0, ""}}};
  s.spheres = {{{0, 0, 0}, 1, 0, ""}, {{1, 0, 2}, 50, 1, ""}};
  s.render.samples = 64;
  s.render.sampler = scene::Sampler::kIndependent;
  s.render.direct_lighting = mode;
  return s;
}

/// Every path carries the shell's radiance, or that times the albedo if it met the ball, without noise. How many meet
/// it follows from its outline, a disc.
TEST(RenderLitLoop, ABallInAnEmissiveShellHasItsAlbedoTimesTheRadiance) {
  constexpr int kSamples = 64;
  double largest = 0;
  const double angle = std::asin(1.0 / 4), half_height = std::tan(std::numbers::pi / 6);
  const double covered = std::numbers::pi * std::pow(std::tan(angle), 2) / (4 * half_height * half_height);
  for (const double albedo : {0.0, 0.5, 1.0}) {
    for (const auto mode : {scene::DirectLighting::kMis, scene::DirectLighting::kBsdf, scene::DirectLighting::kLight}) {
      const compile::CompiledScene compiled = compile::compile(ball_in_a_shell(albedo, mode));
      Rendered out;
      render_tile(compiled, compiled.view(), Kind::kLit, false, out);
      EXPECT_EQ(out.counts.bad_samples, 0u);
      int on_ball = 0, pixels_on_ball = 0;
      for (const kernel::PixelSum& sum : out.sums) {
        ASSERT_EQ(sum.weight, kSamples);
        const double red = kernel::from_fixed_point(sum.rgb[0]);
        const double hits = albedo == 1 ? 0 : (3 * kSamples - red) / (3 * (1 - albedo));
        ASSERT_NEAR(hits, std::round(hits), 1e-11);
        on_ball += static_cast<int>(std::round(hits));
        for (int c = 0; c < 3; ++c) {
          const double radiance = 3 - c;
          const double expected = radiance * (kSamples - std::round(hits) * (1 - albedo));
          const double error = (kernel::from_fixed_point(sum.rgb[c]) - expected) / (radiance * kSamples);
          ASSERT_LE(std::abs(error), 1e-12);
          largest = std::max(largest, std::abs(error));
        }
        pixels_on_ball += std::round(hits) == kSamples;
      }
      if (albedo == 1) continue;
      EXPECT_GT(pixels_on_ball, 20);
      const double paths = kSamples * static_cast<double>(out.sums.size());
      const double z = (on_ball - covered * paths) / std::sqrt(paths * covered * (1 - covered));
      EXPECT_LT(std::abs(z), 4) << albedo;
    }
  }
  std::printf("a ball in an emissive shell: largest relative error of a pixel %.1e\n", largest);
}

/// Balls that see each other: with albedo 1 every path carries the radiance of the shell, after any number of bounces.
TEST(RenderLitLoop, WhiteBallsInAnEmissiveShellAreInvisible) {
  for (const auto mode : {scene::DirectLighting::kMis, scene::DirectLighting::kBsdf, scene::DirectLighting::kLight}) {
    scene::Scene s = ball_in_a_shell(1, mode);
    s.spheres.push_back({{1.5, 0.2, 1}, 0.7, 0, ""});
    s.spheres.push_back({{-1, -0.4, 1.2}, 0.5, 0, ""});
    s.render.max_depth = 10000;
    const compile::CompiledScene compiled = compile::compile(s);
    Rendered out;
    render_tile(compiled, compiled.view(), Kind::kLit, false, out);
    for (const kernel::PixelSum& sum : out.sums)
      for (int c = 0; c < 3; ++c)
        ASSERT_NEAR(kernel::from_fixed_point(sum.rgb[c]) / (64 * (3 - c)), 1, 1e-12) << static_cast<int>(mode);
  }
}

TEST(RenderLitLoop, AbsorbedPathsKeepTheirLight) {
  const Furnace furnace(scene::Precision::kExact, 10, 4, scene::Metal{{0.5, 0.5, 0.5}, 1});
  Rendered out;
  render_tile(furnace.compiled, furnace.view, Kind::kLit, true, out);
  EXPECT_LT(out.counts.rays, 10 * out.records.size()) << "some are absorbed";
  std::vector<double> of_path(out.records.size()), of_pixel(out.sums.size());
  for (const kernel::LightEvent& e : out.all_events()) of_path[e.path] += e.value[0];
  for (std::size_t i = 0; i < of_path.size(); ++i) {
    EXPECT_GE(of_path[i], 4);
    EXPECT_EQ(of_path[i], out.records[i].light[0]);
    of_pixel[i / 16] += of_path[i];
  }
  for (std::size_t i = 0; i < of_pixel.size(); ++i)
    EXPECT_EQ(of_pixel[i], kernel::from_fixed_point(out.sums[i].rgb[0]));
}

TEST(RenderLitLoop, LobesAddUpToTheBeauty) {
  const Furnace furnace(scene::Precision::kExact, 5, 4);
  Rendered out;
  render_tile(furnace.compiled, furnace.view, Kind::kLit, true, out);
  film::LayerRequest request;
  request.diffuse = request.background = true;
  film::LayerSums layers(request, out.sums.size());
  for (const kernel::LightEvent& e : out.all_events()) layers.add(request, e.path / 16, out.records[e.path], e);
  for (std::size_t i = 0; i < out.sums.size(); ++i) {
    kernel::Int128 sum = 0;
    for (std::size_t lobe = 0; lobe < kernel::kLobes; ++lobe) sum += layers.light[i * kernel::kLobes + lobe][1];
    EXPECT_TRUE(sum == out.sums[i].rgb[1]);
  }
}

TEST(RenderLitLoop, ABadChannelMakesThePathBad) {
  for (const auto precision : {scene::Precision::kExact, scene::Precision::kFast})
    for (const double bad : {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN(), 1e30})
      for (int channel = 0; channel < 3; ++channel) {
        Furnace furnace(precision, 1, 1);
        for (kernel::Emission& e : furnace.emission) e.radiance[channel] = bad;
        Rendered out;
        render_tile(furnace.compiled, furnace.view, Kind::kLit, false, out);
        EXPECT_EQ(out.counts.bad_samples, out.sums.size() * 16) << bad << ", channel " << channel;
        for (const kernel::PixelSum& sum : out.sums)
          ASSERT_TRUE(sum.weight == 0 && sum.rgb[0] == 0 && sum.rgb[1] == 0 && sum.rgb[2] == 0);
      }
}

TEST(RenderLitLoop, ABadValueCostsAPathItsWeightOnce) {
  for (const auto precision : {scene::Precision::kExact, scene::Precision::kFast}) {
    for (const double bad : {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
      const Furnace furnace(precision, 7, bad);
      Rendered out;
      render_tile(furnace.compiled, furnace.view, Kind::kLit, true, out);
      EXPECT_EQ(out.counts.bad_samples, out.records.size());
      for (const kernel::PixelSum& sum : out.sums) {
        ASSERT_EQ(sum.weight, 0);
        ASSERT_TRUE(sum.rgb[0] == 0);
      }
      film::LayerRequest request;
      request.diffuse = true;
      film::LayerSums layers(request, 1);
      for (const kernel::LightEvent& e : out.all_events()) layers.add(request, 0, out.records[e.path], e);
      for (const auto& lobe : layers.light) ASSERT_TRUE(lobe[0] == 0);
    }
  }
}

}  // namespace
}  // namespace orrery::render
