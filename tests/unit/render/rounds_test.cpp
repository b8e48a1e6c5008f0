// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <mutex>

#include "compile/compile.h"
#include "render/render.h"
#include "support/everything.h"

namespace orrery::render {
namespace {

compile::World world_of(int samples = 100) {
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

TEST(RenderRounds, ThreadsAndTraversalsChangeNoBit) {
  Settings settings = noise(0.012);
  settings.threads = 1;
  const Result one = render(world_of(), settings);
  EXPECT_EQ(one.statistics.ended_by, "noise");
  EXPECT_LT(one.statistics.fewest_samples, one.statistics.most_samples);
  settings.threads = 5;
  settings.traversal = Traversal::kSingle;
  const Result five = render(world_of(), settings);
  expect_same(one.picture, five.picture);
  EXPECT_EQ(one.statistics.paths, five.statistics.paths);
}

TEST(RenderRounds, MoreAccuracyTakesMoreSamples) {
  const Result rough = render(world_of(), noise(0.02)), fine = render(world_of(), noise(0.005));
  EXPECT_LE(*rough.statistics.noise, 0.02);
  EXPECT_LE(*fine.statistics.noise, 0.005);
  EXPECT_GT(*fine.statistics.noise, 0.0035);  // and not more than was asked for
  EXPECT_GT(fine.statistics.paths, 4 * rough.statistics.paths);
}

TEST(RenderRounds, SamplesAreALimitWhereTheyWereAskedFor) {
  Settings settings = noise(0.001);
  settings.unlimited = false;
  const Result r = render(world_of(40), settings);
  EXPECT_TRUE(r.completed);
  EXPECT_EQ(r.statistics.ended_by, "samples");
  EXPECT_EQ(r.statistics.most_samples, 40u);
  EXPECT_GT(*r.statistics.noise, 0.001);
}

TEST(RenderRounds, LayersCountThePathsThatWereTaken) {
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
  EXPECT_EQ(static_cast<std::uint64_t>(fewest), r.statistics.fewest_samples);
  EXPECT_EQ(static_cast<std::uint64_t>(most), r.statistics.most_samples);
  // The beauty is the one without layers.
  const Result bare = render(world_of(), noise(0.012));
  for (const char* name : {"R", "G", "B"}) EXPECT_EQ(r.picture.find(name)->values, bare.picture.find(name)->values);
}

TEST(RenderRounds, NegativeLobesAndBlueNoiseWorkInRounds) {
  scene::Scene s = test::everything();
  s.image = {40, 24};
  s.render.filter = scene::Filter::kMitchell;
  s.render.sampler = scene::Sampler::kBlueNoise;
  const Result r = render(compile::compile(s), noise(0.05));
  EXPECT_EQ(r.statistics.ended_by, "noise");
  for (const float v : r.picture.planes[0].values) ASSERT_TRUE(std::isfinite(v));
}

TEST(RenderRounds, TimeIsKept) {
  // The clock counts samples, so that the result does not depend on the machine.
  for (const double seconds : {0.3, 1.0, 20.0}) {
    Settings settings;
    settings.clock = [](std::uint64_t samples) { return static_cast<double>(samples) * 1e-5; };
    settings.seconds = seconds;
    settings.unlimited = true;
    const Result r = render(world_of(), settings);
    EXPECT_EQ(r.statistics.ended_by, "time");
    EXPECT_NEAR(r.statistics.render_s, seconds, 0.05 * seconds);
  }
}

TEST(RenderRounds, AnEmptyViewIsDoneAtOnce) {
  scene::Scene s;
  s.image = {20, 10};
  s.background.type = scene::BackgroundType::kConstant;
  const Result r = render(compile::compile(s), noise(0.001));
  EXPECT_EQ(r.statistics.ended_by, "noise");
  EXPECT_EQ(r.statistics.most_samples, 16u);
  EXPECT_EQ(r.picture.planes[0].values[0], 1.0f);
}

TEST(RenderRounds, ProgressGoesForwardAndSaysWhatEndsIt) {
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

TEST(RenderRounds, ACancelledOneIsNotComplete) {
  std::atomic<bool> cancel{false};
  Settings settings = noise(1e-5);
  settings.cancel = &cancel;
  settings.on_progress = [&](const Progress&) { cancel = true; };
  EXPECT_FALSE(render(world_of(), settings).completed);
}

}  // namespace
}  // namespace orrery::render
