// SPDX-License-Identifier: Apache-2.0
#include "job/resources.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "base/available_memory.h"
#include "base/error.h"
#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "denoise/denoise.h"
#include "film/layer_sums.h"
#include "film/layers.h"
#include "generate/generate.h"
#include "job/layers.h"
#include "job/run_job.h"
#include "render/render.h"
#include "render/result.h"
#include "render/settings.h"
#include "scene/scene.h"
#include "support/peak_memory.h"
#include "support/temp_dir.h"

namespace orrery::job {
namespace {

class JobMachine : public testing::Test {
 protected:
  JobMachine() { TearDown(); }
  void TearDown() override {
    ::unsetenv("SLURM_CPUS_PER_TASK");
    ::unsetenv("CUE_THREADS");
  }
  const int all_ = render::available_threads();
};

TEST_F(JobMachine, DefaultIsTheAffinityMask) { EXPECT_EQ(default_threads(), all_); }

TEST_F(JobMachine, SchedulersLimitTheDefault) {
  ::setenv("SLURM_CPUS_PER_TASK", "1", 1);
  EXPECT_EQ(default_threads(), 1);
  ::unsetenv("SLURM_CPUS_PER_TASK");
  ::setenv("CUE_THREADS", "1", 1);
  EXPECT_EQ(default_threads(), 1);
}

TEST_F(JobMachine, QuotasOfControlGroupsLimitTheDefault) {
  const support::TempDir root;
  std::filesystem::create_directories(root / "proc/self");
  std::filesystem::create_directories(root / "sys/fs/cgroup");
  support::write_bytes(root / "proc/self/cgroup", "0::/\n");
  support::write_bytes(root / "sys/fs/cgroup/cpu.max", "50000 100000\n");
  EXPECT_EQ(default_threads(root.path()), 1);
}

TEST_F(JobMachine, SchedulersCannotExceedTheAffinityMask) {
  ::setenv("SLURM_CPUS_PER_TASK", "100000", 1);
  EXPECT_EQ(default_threads(), all_);
}

TEST_F(JobMachine, InvalidVariablesAreIgnored) {
  for (const char* text : {"", "abc", "0", "-1", "1x", "99999999999999999999"}) {
    ::setenv("SLURM_CPUS_PER_TASK", text, 1);
    EXPECT_EQ(default_threads(), all_) << text;
  }
}

constexpr std::uint64_t kMega = 1 << 20;

compile::CompiledScene spheres_at(int width, int spheres, scene::Accelerator accelerator) {
  scene::Scene scene;
  scene.materials = {{"a", scene::Lambertian{}}};
  for (int i = 0; i < spheres; ++i) scene.spheres.push_back({{1.0 * i, 0, 0}, 0.1, 0, ""});
  scene.image = {width, 10};
  scene.render.accelerator = accelerator;
  return compile::compile(scene);
}

TEST(JobMemoryEstimate, GrowsWithPixelsAndSpheres) {
  constexpr auto kEmbree = scene::Accelerator::kEmbree, kList = scene::Accelerator::kList;
  const auto estimate = [](int width, int spheres, scene::Accelerator accelerator,
                           const film::LayerRequest& layers = {}, bool is_adaptive = false) {
    return estimate_memory(spheres_at(width, spheres, accelerator), layers, {.is_adaptive = is_adaptive});
  };
  film::LayerRequest normals;
  normals.normal = true;
  EXPECT_EQ(estimate(10, 0, kEmbree).total(), estimate(10, 0, kList).total());
  EXPECT_EQ(estimate(20, 0, kEmbree).film, 2 * estimate(10, 0, kEmbree).film);
  EXPECT_GT(estimate(10, 0, kEmbree, normals).film, estimate(10, 0, kEmbree).film);
  EXPECT_GT(estimate(10, 0, kEmbree, {}, true).film, estimate(10, 0, kEmbree).film);
  EXPECT_EQ(estimate(1, 100, kList).accelerator, 0u);
  EXPECT_EQ(estimate(1, 100, kEmbree).accelerator, 100 * estimate(1, 1, kEmbree).accelerator);
  EXPECT_EQ(estimate(1, 101, kEmbree).spheres, estimate(1, 1, kEmbree).spheres + 100 * sizeof(kernel::Sphere));
  EXPECT_EQ(estimate_memory(spheres_at(1, 100, kEmbree), {}, {.has_accelerator = true}).accelerator, 0u)
      << "there is one";
}

/// Many spheres of similar size take less each, also if they move a little, then 4 bytes more for their paths; fast
/// ones and giants do not.
TEST(JobMemoryEstimate, CountsTheSpheresInTheBvh) {
  scene::Scene scene;
  scene.materials = {{"a", scene::Lambertian{}}};
  for (int i = 0; i < 30'000; ++i) scene.spheres.push_back({{1.0 * i, 0, 0}, 0.1, 0, ""});
  const auto accelerator_of = [&](const scene::Scene* closing) {
    return estimate_memory(compile::compile(scene, closing), {}).accelerator;
  };
  const std::uint64_t one = estimate_memory(spheres_at(1, 1, scene::Accelerator::kEmbree), {}).accelerator,
                      still = accelerator_of(nullptr);
  EXPECT_LT(still, 30'000 * one / 3);
  scene::Scene closing = scene;
  for (scene::Sphere& s : closing.spheres) s.center.y = 0.1;
  EXPECT_NEAR(static_cast<double>(accelerator_of(&closing)), static_cast<double>(still + 30'000 * 4), 64);
  for (scene::Sphere& s : closing.spheres) s.center.y = 100;
  EXPECT_EQ(accelerator_of(&closing), 30'000 * one);
  for (int i = 0; i < 10'000; ++i) scene.spheres[static_cast<std::size_t>(i)].radius = 10;
  EXPECT_NEAR(static_cast<double>(accelerator_of(nullptr)), static_cast<double>(still / 3 * 2 + 10'000 * one),
              static_cast<double>(one));
}

TEST(JobMemoryEstimate, GrowsWithLightGroups) {
  scene::Scene scene;
  scene.materials = {{"a", scene::Emitter{{1, 1, 1}, 0, "a"}}, {"b", scene::Emitter{{1, 1, 1}, 0, "b"}}};
  scene.spheres = {{{0, 0, 0}, 1, 0, ""}, {{3, 0, 0}, 1, 1, ""}};
  scene.image = {100, 10};
  const auto film_of = [&](std::vector<std::string> layers) {
    scene.output.layers = std::move(layers);
    const compile::CompiledScene compiled = compile::compile(scene);
    const film::LayerRequest request = choose_layers(scene, compiled).request;
    return estimate_memory(compiled, request).film;
  };
  // The light of a pixel with emitters in two groups and the background in a third.
  const std::uint64_t sum = 8 * 3 * 16, planes = (2 * 8 + 8) * 3 * 8;
  EXPECT_EQ(film_of({"light_groups"}) - film_of({"samples"}), 1000 * (3 * sum + planes - 8));
  EXPECT_EQ(film_of({"emission"}) - film_of({"samples"}), 1000 * (sum + 3 * 8 - 8));
}

/// A pixel has a sum for each object of a matte that its paths hit, and for each sphere of a deep image.
TEST(JobMemoryEstimate, GrowsWithTheCoverageOfMattesAndDeepImages) {
  scene::Scene scene;
  scene.materials = {{"a", scene::Lambertian{}}};
  scene::Points cloud;
  cloud.centers.resize(100'000);
  cloud.radii = {1};
  scene.points = {cloud};
  scene.image = {100, 10};
  scene.render.samples = 500;
  const auto film_of = [&](std::vector<std::string> layers, bool deep) {
    scene.output.layers = std::move(layers);
    const compile::CompiledScene compiled = compile::compile(scene);
    film::LayerRequest request = choose_layers(scene, compiled).request;
    request.deep = deep;
    return estimate_memory(compiled, request).film;
  };
  const std::uint64_t planes = (12 - 1) * 8, share = sizeof(film::SphereCoverage) * 3 / 2,
                      heap = 16 + sizeof(std::vector<film::SphereCoverage>);
  EXPECT_EQ(film_of({"CryptoObject"}, false) - film_of({"samples"}, false), 1000 * (planes + share + heap))
      << "one object";
  EXPECT_EQ(film_of({"samples"}, true) - film_of({"samples"}, false), 1000 * (102 * share + heap));
  scene.render.samples = 5;
  EXPECT_EQ(film_of({"samples"}, true) - film_of({"samples"}, false), 1000 * (5 * share + heap)) << "five paths";
}

/// Denoising needs a second sum of the light, and two of the guides.
TEST(JobMemoryEstimate, CountsTheHalvesOnlyWhereTheyAreNeeded) {
  scene::Scene scene;
  scene.image = {100, 10};
  const compile::CompiledScene compiled = compile::compile(scene);
  film::LayerRequest request;
  const auto film = [&] { return estimate_memory(compiled, request).film; };
  const std::uint64_t beauty = film();
  request.halves = true;
  constexpr std::uint64_t kPlanes = 20 * 8;
  EXPECT_EQ(film() - beauty, 1000 * (sizeof(kernel::PixelSum) + 2 * sizeof(kernel::GuideSum) + kPlanes));
}

/// A denoised figure on a page: sums of pixels without objects take no memory, and others none in the finished image.
TEST(JobMemoryEstimate, IsNearThePeakOfAFigureOnAnEmptyPage) {
  if (!support::kMeasuresMemory) GTEST_SKIP() << "sanitizers take memory of their own";
  scene::Scene scene;
  scene.image = {1200, 900};
  scene.background.type = scene::BackgroundType::kConstant;
  scene.materials = {{"a", scene::Lambertian{}}};
  scene.spheres = {{{0, 0, -10}, 3, 0, ""}};
  scene.camera.look_from = {0, 0, 0};
  scene.camera.look_at = {0, 0, -1};
  scene.render.samples = 2;
  const compile::CompiledScene compiled = compile::compile(scene);
  render::Settings settings;
  settings.threads = 1;
  settings.keeps_sums = false;
  settings.layers.halves = true;
  const auto render = [&] {
    render::Result result = render::render(compiled, settings);
    denoise::denoise(result.picture, 1, false);
  };
  const auto peak = static_cast<double>(support::peak_memory(render) - support::peak_memory([] {}));
  const double share = render::share_with_objects(compiled, settings.layers, 1);
  EXPECT_GT(share, 0.02);
  EXPECT_LT(share, 0.2);
  const auto estimate = [&](const MemoryUse& use) {
    return static_cast<double>(estimate_memory(compiled, settings.layers, use).total());
  };
  const double estimated = estimate({.keeps_sums = false, .share_with_objects = share});
  EXPECT_GT(estimated, 0.9 * peak);
  EXPECT_LT(estimated, 1.5 * peak);
  EXPECT_GT(estimate({.share_with_objects = share}), estimated);
  EXPECT_GT(estimate({.keeps_sums = true}), 2 * peak);
  // Pixels are counted before a render is refused.
  const auto limit = static_cast<std::uint64_t>(estimated);
  EXPECT_NO_THROW(require_memory(compiled, settings.layers, {.keeps_sums = false}, limit, 1));
  EXPECT_THROW(require_memory(compiled, settings.layers, {.keeps_sums = false}, limit / 2, 1), base::Error);
}

TEST(JobMemoryEstimate, CountsTheLightTreeAndItsBuild) {
  scene::Scene scene;
  scene.materials = {{"lamp", scene::Emitter{{1, 1, 1}, 0, ""}}};
  for (int i = 0; i < 1000; ++i) scene.spheres.push_back({{1.0 * i, 0, 0}, 0.1, 0, ""});
  const MemoryEstimate lit = estimate_memory(compile::compile(scene), {});
  EXPECT_EQ(lit.lights, 1000u * (48 + 48));
  scene.render.direct_lighting = scene::DirectLighting::kBsdf;
  const MemoryEstimate without = estimate_memory(compile::compile(scene), {});
  EXPECT_EQ(without.lights, 0u) << "no tree is built";
  EXPECT_EQ(lit.total(), without.total() + lit.lights);
  EXPECT_NE(text_of(lit).find(", lights 93.8 KiB"), std::string::npos) << text_of(lit);
}

TEST(JobMemoryEstimate, CountsTheListsOfLampsThatTheCameraSees) {
  const auto lights = [](double radius) {
    scene::Scene scene;
    scene.image = {100, 50};
    scene.camera.look_from = {0, 0, 10};
    scene.camera.look_at = {0, 0, 0};
    scene.materials = {{"lamp", scene::Emitter{{1, 1, 1}, 0, ""}}};
    for (int i = 0; i < 100; ++i) scene.spheres.push_back({{0.01 * i, 0, 0}, radius, 0, ""});
    return estimate_memory(compile::compile(scene), {}).lights;
  };
  const std::uint64_t of_pixels = 100 * 50 * 8, of_small_lamps = lights(0.001) - lights(1);
  EXPECT_GT(of_small_lamps, of_pixels + 100 * 12);
  EXPECT_LT(of_small_lamps, of_pixels + 100 * 300);
}

TEST(JobMemoryEstimate, CountsTheBackgroundOnce) {
  MemoryEstimate estimate;
  estimate.background = 1000 * kMega;
  EXPECT_EQ(estimate.total(), 1000 * kMega);
  EXPECT_NE(text_of(estimate).find(", background 1000.0 MiB"), std::string::npos) << text_of(estimate);
  // What is held already needs no free memory, but counts against a limit.
  const std::uint64_t free_memory = base::available_memory().value_or(0);
  estimate.background = free_memory + (1 << 30);
  EXPECT_THROW(require_memory(estimate, 0), base::Error);
  EXPECT_NO_THROW(require_memory(estimate, 0, estimate.background));
  EXPECT_THROW(require_memory(estimate, kMega, estimate.background), base::Error);
}

/// Compiled spheres and textures no longer need free memory.
TEST(JobMemoryEstimate, WhatTheCompiledSceneHoldsNeedsNoFreeMemory) {
  MemoryEstimate estimate;
  estimate.spheres = 1 * kMega;
  estimate.textures = 2 * kMega;
  estimate.background = 4 * kMega;
  estimate.lights = 8 * kMega;  // most of it is temporary
  EXPECT_EQ(estimate.held(), 7 * kMega);
  estimate.spheres = base::available_memory().value_or(0) + (1 << 30);
  EXPECT_THROW(require_memory(estimate, 0), base::Error);
  EXPECT_NO_THROW(require_memory(estimate, 0, estimate.held()));
}

TEST(JobMemoryEstimate, LoadedSpheresAreNotCompiledWithoutMemoryForBoth) {
  scene::Scene scene;
  scene.points.resize(2);
  for (int i = 0; i < 1000; ++i) {
    scene.points[0].centers.push_back({1.0 * i, 2, 3});
    scene.points[0].radii.push_back(1);
    scene.points[1].centers.push_back({5.0 * i, 2, 3});
    scene.points[1].radii.push_back(2);
    scene.points[1].colors.push_back(0);
  }
  const std::uint64_t needed = 2 * 12'000 + 2000 + 2 * 13'000;
  EXPECT_NO_THROW(require_memory_to_compile(scene, needed));
  EXPECT_THROW(require_memory_to_compile(scene, needed - 1), base::Error);
  EXPECT_NO_THROW(require_memory_to_compile(scene, 0));
}

TEST(JobMemoryEstimate, RejectsWhatDoesNotFitWithTheEstimate) {
  MemoryEstimate million;
  million.spheres = 16'000'000;
  million.accelerator = 130'000'000;
  EXPECT_NO_THROW(require_memory(million, million.total()));
  try {
    require_memory(million, million.total() - 1);
    FAIL();
  } catch (const base::Error& error) {
    EXPECT_EQ(error.kind(), base::ErrorKind::kNoMemory);
    EXPECT_NE(std::string(error.what()).find("needs about 139.2 MiB"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("--memory-limit"), std::string::npos) << error.what();
  }
}

class JobDiskSpace : public testing::Test {
 protected:
  JobDiskSpace() {
    generate::generate_final({}, folder_ / "final.toml");
    job_.scene.file = folder_ / "final.toml";
    job_.scene.overrides = {"image.width=200", "image.height=112", "render.samples=4"};
  }

  /// Ratio of the estimated to the actual size of a file.
  double ratio(const std::string& name, const film::LayerRequest& layers = {}) {
    job_.outputs.images = {folder_ / name};
    run_job(job_);
    const auto needed = estimate_disk_space(job_, 200, 112, layers);
    EXPECT_EQ(needed.size(), 1u);
    return needed.begin()->second / static_cast<double>(std::filesystem::file_size(folder_ / name));
  }

  support::TempDir folder_;
  Job job_;
};

TEST_F(JobDiskSpace, TheEstimateIsNearTheFiles) {
  for (const char* name : {"a.exr", "a.hdr", "a.png", "a.tif", "a.jpg", "a.ppm"}) {
    const double r = ratio(name);
    EXPECT_GT(r, 0.8) << name;  // the header is a large part of so small a file
    EXPECT_LT(r, 1.6) << name;
  }
  for (const char* compression : {"none", "rle", "zip", "piz", "dwaa"}) {
    job_.outputs.exr.compression = compression;
    EXPECT_GT(ratio("b.exr"), 0.8) << compression;
    EXPECT_LT(ratio("b.exr"), 1.6) << compression;
  }
  job_.outputs.exr.compression = "zips";
  job_.settings.sample_end = 2;
  EXPECT_GT(ratio("shard.exr"), 0.8);
  EXPECT_LT(ratio("shard.exr"), 1.6);
}

TEST_F(JobDiskSpace, LayersIncreaseTheEstimate) {
  job_.scene.overrides.add("output.layers=[\"Z\", \"N\", \"variance\"]");
  film::LayerRequest layers;
  layers.z = layers.normal = layers.variance = true;
  EXPECT_GT(ratio("a.exr", layers), 0.8);
  EXPECT_LT(ratio("b.exr", layers), 2);  // distances compress better than noise
}

/// The light of one group, which is the whole image.
TEST_F(JobDiskSpace, LightGroupsIncreaseTheEstimate) {
  job_.scene.overrides.add("output.layers=[\"light_groups\"]");
  film::LayerRequest layers;
  layers.light_groups = true;
  layers.groups = {{"default", false, true}};
  EXPECT_GT(ratio("a.exr", layers), 0.8);
  EXPECT_LT(ratio("a.exr", layers), 3);  // in most pixels most lobes are black
  job_.settings.sample_end = 2;
  EXPECT_GT(ratio("shard.exr", layers), 0.8);
  EXPECT_LT(ratio("shard.exr", layers), 5);  // there are no other layers
}

TEST_F(JobDiskSpace, ALimitReplacesTheFreeSpace) {
  job_.outputs.images = {folder_ / "a.exr"};
  job_.resources.disk_limit = std::uint64_t{1} << 30;
  const auto require = [&] { require_disk_space(job_, 65536, 65536, {}); };  // 16 GiB
  try {
    require();
    ADD_FAILURE() << "no error";
  } catch (const base::Error& error) {
    EXPECT_EQ(error.kind(), base::ErrorKind::kCannotCreate);
    EXPECT_NE(std::string(error.what()).find("--disk-limit allows"), std::string::npos) << error.what();
  }
  job_.resources.disk_limit = std::uint64_t{1} << 50;
  EXPECT_NO_THROW(require()) << "whoever gives a limit insists";
}

}  // namespace
}  // namespace orrery::job
