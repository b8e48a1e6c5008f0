// SPDX-License-Identifier: Apache-2.0
#include "study/bench.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <fstream>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "kernel/isa.h"
#include "support/temp_dir.h"

namespace orrery::study {
namespace {

constexpr const char* kGreySphere = R"(
image = { width = 300, height = 200 }
material.grey = { type = "lambertian", albedo = [0.5, 0.5, 0.5] }
sphere = [{ center = [0, 0, -2], radius = 1, material = "grey" }]
)";

class StudyBenchScene : public testing::Test {
 protected:
  BenchRequest request() {
    const auto file = folder_.path() / "scene.toml";
    std::ofstream(file) << kGreySphere;
    BenchRequest r;
    r.scene.file = file;
    r.rounds = 3;
    r.seconds = 0.001;
    return r;
  }

 private:
  support::TempDir folder_;
};

std::vector<std::string> names(const std::vector<BenchResult>& cases) {
  std::vector<std::string> out;
  for (const BenchResult& c : cases) out.push_back(c.name);
  return out;
}

TEST_F(StudyBenchScene, MeasuresEveryPrecisionWithEmbreeAndLists) {
  const Benchmark b = bench_scene(request());
  EXPECT_EQ(names(b.cases), (std::vector<std::string>{"embree exact", "embree fast", "exact packet", "exact single",
                                                      "list exact", "list fast", "list book"}));
  EXPECT_EQ(b.spheres, 1u);
  EXPECT_EQ(b.threads, 1);
  EXPECT_GT(b.rays_per_path, 1);
  EXPECT_LE(b.rays_per_path, 2);
  EXPECT_NEAR(b.width * b.height, 96 * 54, 100);
  EXPECT_NEAR(static_cast<double>(b.width) / b.height, 1.5, 0.05);
  for (const BenchResult& c : b.cases) {
    EXPECT_GT(c.speed.low, 0) << c.name;
    EXPECT_LE(c.speed.low, c.speed.median) << c.name;
    EXPECT_LE(c.speed.median, c.speed.high) << c.name;
  }
  EXPECT_EQ(b.cases[0].ratio.low, 1);
  EXPECT_EQ(b.cases[0].ratio.high, 1);
  EXPECT_TRUE(b.left_out.empty());
}

/// Shadow rays are rays of "embree exact" only.
TEST_F(StudyBenchScene, RaysPerPathAreThoseOfTheScene) {
  BenchRequest r = request();
  std::ofstream(r.scene.file)
      << "image = { width = 300, height = 200 }\nbackground = { type = \"constant\", color = [0, 0, 0] }\n"
         "material.grey = { type = \"lambertian\", albedo = [0.5, 0.5, 0.5] }\n"
         "material.lamp = { type = \"emitter\", radiance = [1, 1, 1] }\n"
         "sphere = [{ center = [0, 0, -2], radius = 1, material = \"grey\" },\n"
         "  { center = [0, 9, -2], radius = 1, material = \"lamp\" }]\n";
  const double with = bench_scene(r).rays_per_path;
  r.scene.overrides = {"render.direct_lighting=bsdf"};
  EXPECT_GT(with, bench_scene(r).rays_per_path + 0.05);
}

TEST_F(StudyBenchScene, MeasuresMotionBlur) {
  BenchRequest r = request();
  std::ofstream(r.scene.file, std::ios::app) << "camera = { shutter_close = 0.5 }\n"
                                                "key = [{ target = \"sphere[0].center\", frames = [1, 2], "
                                                "values = [[0, 0, -2], [1, 0, -2]] }]\n";
  const std::string moving = bench_scene(r).scene_hash;
  r.scene.overrides = {"camera.shutter_close=0"};
  EXPECT_NE(bench_scene(r).scene_hash, moving);
}

TEST_F(StudyBenchScene, ReportsTheInstructionSetUsed) {
  for (const std::string& isa : kernel::available_isas()) {
    ::setenv("ORRERY_ISA", isa.c_str(), 1);
    EXPECT_EQ(bench_scene(request()).isa, isa);
  }
  ::unsetenv("ORRERY_ISA");
  EXPECT_EQ(bench_scene(request()).isa, kernel::available_isas().front());
}

TEST_F(StudyBenchScene, StopsWhenCancelled) {
  BenchRequest r = request();
  const std::atomic<bool> cancel{true};
  r.cancel = &cancel;
  try {
    bench_scene(r);
    FAIL();
  } catch (const base::Error& error) {
    EXPECT_EQ(error.kind(), base::ErrorKind::kStopped);
  }
}

TEST_F(StudyBenchScene, ReportsProgress) {
  BenchRequest r = request();
  int last = 0, total = 0;
  r.on_progress = [&](int done, int of) {
    EXPECT_EQ(done, last + 1);
    last = done;
    total = of;
  };
  bench_scene(r);
  EXPECT_EQ(last, total);
}

Benchmark some_benchmark() {
  Benchmark b;
  b.scene_hash = "0123";
  b.width = 96;
  b.height = 54;
  b.threads = 1;
  b.rounds = 7;
  b.isa = "avx2";
  b.accelerator = "embree";
  b.rays_per_path = 2.5;
  b.cases = {{"embree exact", {1e6, 2e6, 3e6}, {1, 1, 1}}, {"list book", {1e5, 2e5, 3e5}, {0.05, 0.1, 0.15}}};
  b.left_out = {"something, since"};
  return b;
}

TEST(StudyBenchReport, FormatsTextReport) {
  EXPECT_EQ(benchmark_text(some_benchmark()),
            "scene       0123, 0 spheres, 2.50 rays per path\n"
            "measured    96 x 54 px, 1 thread, avx2, embree; 7 rounds, median (interquartile range)\n"
            "\n"
            "                      M paths/s  ratio to embree exact\n"
            "embree exact                  2  1 (1 .. 1)\n"
            "list book                   0.2  0.1 (0.05 .. 0.15)\n"
            "\n"
            "left out    something, since\n");
}

TEST(StudyBenchReport, FormatsJsonReport) {
  const auto json = nlohmann::json::parse(benchmark_json(some_benchmark()));
  EXPECT_EQ(json["schema"], "orrery.bench/1");
  EXPECT_EQ(json["cases"][1]["ratio"]["high"], 0.15);
  EXPECT_EQ(json["left_out"][0], "something, since");
}

}  // namespace
}  // namespace orrery::study
