// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>
#include <utility>

#include "accel/accel.h"
#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "film/display_error.h"
#include "film/picture.h"
#include "film/sums.h"
#include "render/render.h"
#include "render/result.h"
#include "render/settings.h"
#include "support/everything.h"
#include "support/room.h"

namespace orrery::render {
namespace {

compile::CompiledScene world_of(int samples = 100) {
  scene::Scene s = test::everything();
  s.image = {67, 41};
  s.render.samples = samples;
  return compile::compile(s);
}

Settings noise(double value) {
  Settings settings;
  settings.noise = value;
  settings.unlimited = true;
  return settings;
}

void expect_same(const film::Picture& a, const film::Picture& b) {
  ASSERT_EQ(a.planes.size(), b.planes.size());
  for (std::size_t p = 0; p < a.planes.size(); ++p)
    ASSERT_EQ(a.planes[p].values, b.planes[p].values) << a.planes[p].name;
}

TEST(RenderAdaptiveSampling, ThreadsAndTraversalsGiveTheSameBits) {
  Settings settings = noise(0.012);
  settings.threads = 1;
  const Result one = render(world_of(), settings);
  EXPECT_EQ(one.statistics.ended_by, "noise");
  EXPECT_LT(one.statistics.min_samples, one.statistics.max_samples);
  settings.threads = 5;
  settings.traversal = accel::Traversal::kSingle;
  const Result five = render(world_of(), settings);
  expect_same(one.picture, five.picture);
  EXPECT_EQ(one.statistics.paths, five.statistics.paths);
}

TEST(RenderAdaptiveSampling, LowerTargetNoiseTakesMoreSamples) {
  const Result rough = render(world_of(), noise(0.02)), fine = render(world_of(), noise(0.005));
  EXPECT_LE(*rough.statistics.noise, 0.02);
  EXPECT_LE(*fine.statistics.noise, 0.005);
  EXPECT_GT(*fine.statistics.noise, 0.0035);  // no more accurate than requested
  EXPECT_GT(fine.statistics.paths, 4 * rough.statistics.paths);
}

/// Below a target that is easily reached, the first estimate decides.
TEST(RenderAdaptiveSampling, AnImageThatWillBeDenoisedTakesFewSamplesExceptAtEdges) {
  scene::Scene s;
  s.image = {40, 40};
  s.background.type = scene::BackgroundType::kConstant;
  s.materials = {{"grey", scene::Lambertian{{0.5, 0.5, 0.5}}}};
  s.spheres = {{{0, 0, -3}, 1, 0, "ball"}};
  const compile::CompiledScene compiled = compile::compile(s);
  Settings settings = noise(10);
  EXPECT_EQ(render(compiled, settings).statistics.max_samples, 16u);
  settings.layers.halves = settings.layers.samples = settings.layers.object_id = true;
  const Result r = render(compiled, settings);
  const auto &samples = r.picture.find("samples.X")->values, &ids = r.picture.find("object_id.X")->values;
  const auto at = [](int x, int y) { return static_cast<std::size_t>(40 * y + x); };
  EXPECT_EQ(samples[at(20, 20)], 4.0f);
  EXPECT_EQ(samples[at(0, 0)], 4.0f);
  for (int x = 1; x < 40; ++x)
    if (ids[at(x, 20)] != ids[at(x - 1, 20)]) {
      EXPECT_EQ(std::max(samples[at(x - 1, 20)], samples[at(x, 20)]), 8.0f) << x;
    }
  EXPECT_EQ(r.statistics.max_samples, 8u);
}

TEST(RenderAdaptiveSampling, RequestedSampleCountIsALimit) {
  Settings settings = noise(0.001);
  settings.unlimited = false;
  const Result r = render(world_of(40), settings);
  EXPECT_TRUE(r.completed);
  EXPECT_EQ(r.statistics.ended_by, "samples");
  EXPECT_EQ(r.statistics.max_samples, 40u);
  EXPECT_GT(*r.statistics.noise, 0.001);
}

TEST(RenderAdaptiveSampling, SampleLayerMatchesThePathCount) {
  Settings settings = noise(0.012);
  settings.layers.samples = settings.layers.variance = settings.layers.normal = settings.layers.diffuse = true;
  const Result r = render(world_of(), settings);
  double sum = 0;
  float fewest = 1e9f, most = 0;
  for (const float n : r.picture.find("samples.X")->values) {
    sum += static_cast<double>(n);
    fewest = std::min(fewest, n);
    most = std::max(most, n);
  }
  EXPECT_EQ(sum, static_cast<double>(r.statistics.paths));
  EXPECT_EQ(static_cast<std::uint64_t>(fewest), r.statistics.min_samples);
  EXPECT_EQ(static_cast<std::uint64_t>(most), r.statistics.max_samples);
  // Layers do not change the beauty.
  const Result bare = render(world_of(), noise(0.012));
  for (const char* name : {"R", "G", "B"}) EXPECT_EQ(r.picture.find(name)->values, bare.picture.find(name)->values);
}

TEST(RenderAdaptiveSampling, FiltersAndBlueNoiseWork) {
  scene::Scene s = test::everything();
  s.image = {40, 24};
  s.render.filter = scene::Filter::kBlackmanHarris;
  s.render.sampler = scene::Sampler::kBlueNoise;
  const Result r = render(compile::compile(s), noise(0.05));
  EXPECT_EQ(r.statistics.ended_by, "noise");
  for (const float v : r.picture.planes[0].values) ASSERT_TRUE(std::isfinite(v));
}

TEST(RenderAdaptiveSampling, TimeBudgetIsKept) {
  // The clock counts samples, and the build of the BVH is not part of the budget, so the result does not depend on the
  // machine.
  const compile::CompiledScene world = world_of();
  const auto accel = build(world, 1);
  for (const double seconds : {0.3, 1.0, 20.0}) {
    Settings settings;
    settings.threads = 1;
    settings.clock = [](std::uint64_t samples) { return static_cast<double>(samples) * 1e-5; };
    settings.time_budget_s = seconds;
    settings.unlimited = true;
    const Result r = render(world, *accel, settings);
    EXPECT_EQ(r.statistics.ended_by, "time");
    EXPECT_NEAR(r.statistics.render_s, seconds, 0.05 * seconds);
  }
}

TEST(RenderAdaptiveSampling, EmptyViewFinishesAtOnce) {
  scene::Scene s;
  s.image = {20, 10};
  s.background.type = scene::BackgroundType::kConstant;
  const Result r = render(compile::compile(s), noise(0.001));
  EXPECT_EQ(r.statistics.ended_by, "noise");
  EXPECT_EQ(r.statistics.max_samples, 16u);
  EXPECT_EQ(r.picture.planes[0].values[0], 1.0f);
}

/// Display error of an image relative to the reference.
double error_of(const film::Picture& picture, const film::Picture& truth) {
  double sum = 0;
  const std::size_t pixels = truth.planes[0].values.size();
  for (std::size_t i = 0; i < pixels; ++i) {
    double squares = 0, light = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const auto a = static_cast<double>(picture.planes[c].values[i]),
                 b = static_cast<double>(truth.planes[c].values[i]);
      squares += (a - b) * (a - b);
      light += b;
    }
    sum += film::display_error_squared(squares, light);
  }
  return std::sqrt(sum / static_cast<double>(pixels));
}

TEST(RenderAdaptiveSampling, RareLightIsNotMistakenForBlack) {
  // Four samples in a hundred find light: after sixteen a pixel may look black, or free of noise.
  scene::Scene s = test::room(3.7, 5, 32, 18);
  s.render.samples = 4096;
  s.render.seed = 1000;
  const film::Picture truth = render(compile::compile(s), {}).picture;
  for (const scene::Sampler sampler : {scene::Sampler::kIndependent, scene::Sampler::kSobol}) {
    s.render.sampler = sampler;
    for (std::uint32_t seed = 1; seed <= 4; ++seed) {
      s.render.seed = seed;
      const Result r = render(compile::compile(s), noise(0.3));
      EXPECT_EQ(r.statistics.ended_by, "noise");
      EXPECT_LE(*r.statistics.noise, 0.3);
      EXPECT_LT(*r.statistics.expected_noise, *r.statistics.noise);
      const double error = error_of(r.picture, truth);
      EXPECT_LT(error, 1.1 * 0.3) << seed;
      EXPECT_GT(error, 0.5 * 0.3) << seed;
    }
  }
}

TEST(RenderAdaptiveSampling, BlackIsAcceptedAfter1024Samples) {
  const Result r = render(compile::compile(test::room(3.95, 5, 12, 8)), noise(0.3));
  EXPECT_EQ(r.statistics.ended_by, "noise");
  EXPECT_EQ(r.statistics.min_samples, 1024u);
  EXPECT_EQ(r.statistics.max_samples, 1024u);
  EXPECT_EQ(r.statistics.unreliable_pixels, 0u);
}

TEST(RenderAdaptiveSampling, PixelsWithTooFewSamplesAreCounted) {
  scene::Scene s = test::room(3.95, 5, 12, 8);
  s.render.samples = 64;
  Settings settings = noise(0.3);
  settings.unlimited = false;
  const Result r = render(compile::compile(s), settings);
  EXPECT_TRUE(r.completed);
  EXPECT_EQ(r.statistics.ended_by, "samples");
  EXPECT_EQ(r.statistics.max_samples, 64u);
  EXPECT_EQ(r.statistics.unreliable_pixels, 96u);
}

TEST(RenderAdaptiveSampling, TransparentBackgroundIsKnownToBeBlack) {
  scene::Scene s;
  s.image = {30, 20};
  s.camera.look_from = {0, 0, 9};
  s.materials = {{"m", scene::Lambertian{{0.5, 0.5, 0.5}}}};
  s.spheres = {{{0, 0, 0}, 1, 0, ""}};
  Settings settings = noise(0.2);
  settings.layers.coverage = settings.layers.transparent = true;
  const Result r = render(compile::compile(s), settings);
  EXPECT_EQ(r.statistics.ended_by, "noise");
  EXPECT_EQ(r.statistics.min_samples, 16u);
  EXPECT_LT(r.statistics.paths, 100u * 600u);  // a thousand per pixel if black needed evidence
}

TEST(RenderAdaptiveSampling, ImagesOfFewPixelsFinish) {
  std::uint64_t most = 0;
  for (const auto& [width, height] : {std::pair{1, 1}, {2, 3}, {5, 1}}) {
    scene::Scene s = test::room(3.6, 10, width, height);
    const Result r = render(compile::compile(s), noise(0.1));
    EXPECT_EQ(r.statistics.ended_by, "noise");
    EXPECT_LE(*r.statistics.noise, 0.1);
    most = std::max(most, r.statistics.max_samples);
  }
  EXPECT_GT(most, 16u);
}

TEST(RenderAdaptiveSampling, IsolatedNoisyPixelGetsSamples) {
  // A small sphere before a uniform sky: no other pixel has information about the pixel that contains it.
  scene::Scene s;
  s.image = {24, 16};
  s.camera.look_from = {0, 0, 10};
  s.camera.look_at = {0.2, 0.2, 0};
  s.camera.vfov = 20;
  s.background.type = scene::BackgroundType::kConstant;
  s.materials = {{"soot", scene::Lambertian{{0, 0, 0}}}};
  s.spheres = {{{0, 0, 0}, 0.07, 0, ""}};
  s.render.sampler = scene::Sampler::kIndependent;
  int gone_on = 0;
  for (s.render.seed = 1; s.render.seed <= 4; ++s.render.seed) {
    const Result r = render(compile::compile(s), noise(0.001));
    EXPECT_EQ(r.statistics.ended_by, "noise");
    EXPECT_LT(r.statistics.max_samples, 1u << 20);
    gone_on += r.statistics.max_samples > 16 ? 1 : 0;
  }
  EXPECT_GE(gone_on, 2);
}

TEST(RenderAdaptiveSampling, ResumedRenderGivesTheSameBits) {
  const compile::CompiledScene compiled = compile::compile(test::room(3.7, 5, 33, 18));
  Settings settings = noise(0.3);
  settings.threads = 2;
  const Result whole = render(compiled, settings);
  std::optional<film::Sums> from;
  int stops = 0;
  for (;; ++stops) {
    std::atomic<bool> cancel{false};
    int looks = 0;
    settings.cancel = &cancel;
    settings.checkpoint_is_due = [&] {
      static std::mutex mutex;
      const std::lock_guard lock(mutex);
      if (++looks > 1) cancel = true;  // in the middle of an iteration
      return false;
    };
    Result r = render(compiled, settings, std::move(from));
    if (r.completed) {
      expect_same(r.picture, whole.picture);
      EXPECT_EQ(r.statistics.paths, whole.statistics.paths);
      break;
    }
    from = std::move(r.sums);
  }
  EXPECT_GT(stops, 4);
}

TEST(RenderAdaptiveSampling, ProgressIncreasesAndNamesTheGoal) {
  Settings settings = noise(0.004);
  std::mutex mutex;
  std::vector<double> fractions;
  std::string goal;
  settings.on_progress = [&](const Progress& p) {
    const std::lock_guard lock(mutex);
    fractions.push_back(static_cast<double>(p.samples_done) / static_cast<double>(p.samples_total));
    goal = p.goal;
  };
  render(world_of(), settings);
  ASSERT_FALSE(fractions.empty());
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end(), [](double a, double b) { return a < b - 1e-3; }));
  EXPECT_EQ(goal.rfind("noise 0.0", 0), 0u) << goal;
}

TEST(RenderAdaptiveSampling, CancelledRenderIsNotComplete) {
  std::atomic<bool> cancel{false};
  Settings settings = noise(1e-5);
  settings.cancel = &cancel;
  settings.on_progress = [&](const Progress&) { cancel = true; };
  EXPECT_FALSE(render(world_of(), settings).completed);
}

}  // namespace
}  // namespace orrery::render
