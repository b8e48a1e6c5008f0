// SPDX-License-Identifier: Apache-2.0
#include "study/study.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "compile/environment.h"
#include "info/info.h"
#include "load/load_scene.h"
#include "study/axes.h"
#include "support/everything.h"
#include "support/lit_scenes.h"
#include "support/temp_dir.h"

namespace orrery::study {
namespace {

/// Time is counted in paths, so that the tests do not depend on the speed of the machine.
constexpr double kPathsPerSecond = 1e6;

class StudyRun : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder = new support::TempDir;
    std::ofstream(*folder / "scene.toml")
        << "[image]\nwidth = 160\nheight = 90\n[camera]\nlook_from = [0, 1, 4]\n"
           "look_at = [0, 0.3, 0]\nvfov = 40\n[render]\nsamples = 50\n"
           "[material]\nground = { type = \"lambertian\", albedo = [0.5, 0.5, 0.5] }\n"
           "glass = { type = \"dielectric\" }\n"
           "[[sphere]]\ncenter = [0, -100, 0]\nradius = 100\nmaterial = \"ground\"\n"
           "[[sphere]]\ncenter = [0, 0.5, 0]\nradius = 0.5\nmaterial = \"glass\"\n";
    Request request;
    request.scene.file = *folder / "scene.toml";
    request.budget_s = 14;
    request.paths_per_s = kPathsPerSecond;
    request.noise = 0.02;
    study = new Study(run_study(request));
  }
  static void TearDownTestSuite() {
    delete study;
    delete folder;
  }
  static const Point& point(const std::string& axis, const std::string& name) {
    for (const Point& p : study->points)
      if (p.axis == axis && p.name == name) return p;
    throw std::runtime_error("no point " + axis + " " + name);
  }
  static support::TempDir* folder;
  static Study* study;
};
support::TempDir* StudyRun::folder = nullptr;
Study* StudyRun::study = nullptr;

info::SceneInfo info_of(const std::filesystem::path& scene) {
  load::SceneRequest request;
  request.source.file = scene;
  return info::scene_info(request);
}

TEST_F(StudyRun, StaysWithinItsBudget) {
  EXPECT_LT(study->seconds, study->budget_s);
  EXPECT_GT(study->seconds, 0.5 * study->budget_s);
}

TEST_F(StudyRun, EstimatesMemoryAsInfoDoes) {
  const info::SceneInfo info = info_of(*folder / "scene.toml");
  EXPECT_EQ(point("precision", "exact").memory, info.memory.total());
  EXPECT_EQ(study->scene_hash, info.scene_hash);
}

TEST_F(StudyRun, SeparatesBiasFromNoise) {
  // One bounce is not enough for glass. Sixteen times the samples give a quarter of the noise.
  EXPECT_GT(point("depth", "at most 2").bias, 0.02);
  EXPECT_LT(point("depth", "at most 2").measured.energy, -0.005);
  EXPECT_LT(point("precision", "fast").bias, 0.005);
  EXPECT_NEAR(point("sampler", "16 independent").measured.noise / point("sampler", "256 independent").measured.noise, 4,
              0.8);
  EXPECT_LT(point("samples", "64 sobol").error, point("sampler", "64 independent").error);
}

TEST_F(StudyRun, DenoisingTakesNoiseAndMemory) {
  const Point noisy = point("samples", "16 sobol"), denoised = point("denoise", "16 sobol");
  EXPECT_LT(denoised.measured.noise, 0.7 * noisy.measured.noise);
  EXPECT_LT(denoised.error, noisy.error);
  EXPECT_GT(denoised.memory, noisy.memory) << "for the halves of the samples";
}

TEST_F(StudyRun, TheFrontIsParetoOptimal) {
  for (const Point& p : study->points) {
    if (!p.on_front) continue;
    for (const Point& other : study->points)
      EXPECT_FALSE(other.axis != "accelerator" && other.seconds < p.seconds && other.error < p.error)
          << p.name << " is dominated by " << other.name;
  }
}

TEST_F(StudyRun, RecommendsACommand) {
  const Recommendation& r = study->recommendation;
  // The 16 samples that --noise takes at least are more than this scene needs.
  EXPECT_EQ(r.command, "orrery render " + (*folder / "scene.toml").string() + " -o final.exr --samples 5");
  EXPECT_GT(r.seconds, 0);
  EXPECT_LE(r.seconds, r.baseline_seconds);
  EXPECT_LE(r.noise, 0.02);
  EXPECT_GT(r.baseline_seconds, 0);
}

TEST_F(StudyRun, JsonAndPageHoldAllPoints) {
  const auto json = nlohmann::json::parse(study_json(*study));
  EXPECT_EQ(json["schema"], "orrery.study/1");
  EXPECT_EQ(json["points"].size(), study->points.size());
  const std::string page = study_html(*study);
  EXPECT_EQ(page.find("{{DATA}}"), std::string::npos);
  EXPECT_NE(page.find("data:image/jpeg;base64,"), std::string::npos);
  EXPECT_EQ(page.find("https://"), std::string::npos) << "the page must not need a network";
  const auto begin = page.find("type=\"application/json\">") + 24;
  const auto data = nlohmann::json::parse(page.substr(begin, page.find("</script>", begin) - begin));
  EXPECT_EQ(data["points"].size(), study->points.size());
  EXPECT_NE(study_text(*study).find("* Pareto front: no other choice is both faster and more accurate"),
            std::string::npos);
}

Study small_study(const std::filesystem::path& scene, double budget_s, load::Overrides overrides = {}) {
  Request request;
  request.scene.file = scene;
  request.scene.overrides = std::move(overrides);
  request.budget_s = budget_s;
  request.paths_per_s = kPathsPerSecond;
  return run_study(request);
}

TEST_F(StudyRun, ASmallBudgetSkipsAndListsChoices) {
  const Study small = small_study(*folder / "scene.toml", 0.6);
  ASSERT_GE(small.points.size(), 2u);
  EXPECT_EQ(small.points[0].name, "4 sobol");
  EXPECT_EQ(small.points[1].name, "16 sobol");
  const auto is_left_out = [&](const std::string& text) {
    return std::find(small.left_out.begin(), small.left_out.end(), text) != small.left_out.end();
  };
  EXPECT_TRUE(is_left_out("fresnel (exact; schlick; none): exceeds the budget"));
  EXPECT_TRUE(is_left_out("test of the recommendation at full resolution: exceeds the budget"));
  EXPECT_GT(small.recommendation.seconds, 0);
  EXPECT_NE(study_text(small).find("--noise 0.01"), std::string::npos);
  EXPECT_EQ(study_html(small).find("{{DATA}}"), std::string::npos);
}

TEST_F(StudyRun, ATooSmallBudgetIsRefusedWithTheTimeNeeded) {
  try {
    small_study(*folder / "scene.toml", 0.05);
    FAIL();
  } catch (const base::Error& error) {
    EXPECT_EQ(error.kind(), base::ErrorKind::kUsage);
    EXPECT_NE(std::string(error.what()).find("a reference and two choices take 0.467 s"), std::string::npos)
        << error.what();
  }
}

/// Each choice has the memory of a render with its options.
TEST_F(StudyRun, MemoryIncludesTheLightTreeOfTheChoice) {
  const auto file = *folder / "lamps.toml";
  std::string text =
      "image = { width = 64, height = 36 }\nmaterial.lamp = { type = \"emitter\", radiance = [1, 1, 1] }\n";
  for (int i = 0; i < 100; ++i)
    text += "[[sphere]]\ncenter = [" + std::to_string(3 * i) + ", 0, -9]\nradius = 1\nmaterial = \"lamp\"\n";
  std::ofstream(file) << text;
  for (const char* own : {"mis", "bsdf"}) {
    const Study lamps = small_study(file, 14, {std::string("render.direct_lighting=") + own});
    const auto memory = [&](const char* name) {
      for (const Point& p : lamps.points)
        if (p.axis == "direct lighting" && p.name == name) return p.memory;
      throw std::runtime_error(std::string("no point ") + name);
    };
    EXPECT_EQ(memory("mis"), memory("bsdf") + 9600) << own;
  }
}

TEST_F(StudyRun, MotionBlurIsMeasured) {
  const auto file = *folder / "moving.toml";
  std::ofstream(file)
      << "image = { width = 64, height = 36 }\n"
         "camera = { look_from = [0, 0, 4], look_at = [0, 0, 0], shutter_close = 1 }\n"
         "material.grey = { type = \"lambertian\", albedo = [0.5, 0.5, 0.5] }\n"
         "sphere = [{ center = [0, 0, 0], radius = 1, material = \"grey\", name = \"ball\" }]\n"
         "key = [{ target = \"sphere.ball.center\", frames = [1, 2], values = [[0, 0, 0], [2, 0, 0]] }]\n";
  const Study moving = small_study(file, 1), still = small_study(file, 1, {"camera.shutter_close=0"});
  EXPECT_EQ(moving.scene_hash, info_of(file).scene_hash);
  EXPECT_NE(moving.scene_hash, still.scene_hash);
  EXPECT_NE(moving.reference.planes[0].values, still.reference.planes[0].values);
}

}  // namespace
}  // namespace orrery::study
