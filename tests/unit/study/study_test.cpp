// SPDX-License-Identifier: Apache-2.0
#include "study/study.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "compile/compile.h"
#include "study/axes.h"
#include "support/everything.h"
#include "support/scratch_folder.h"

namespace orrery::study {
namespace {

bool has_axis(const AxisPlan& plan, const std::string& axis) {
  return std::any_of(plan.choices.begin(), plan.choices.end(), [&](const Choice& c) { return c.axis == axis; });
}

AxisPlan plan_of(const scene::Scene& s) { return plan_axes(s, compile::compile(s), 0.01); }

TEST(StudyAxes, OnlyWhatTheSceneCanFeelIsMeasured) {
  const AxisPlan all = plan_of(test::everything());
  for (const char* axis : {"samples", "noise", "precision", "sampler", "roulette", "depth", "fresnel", "accelerator"})
    EXPECT_TRUE(has_axis(all, axis)) << axis;
  scene::Scene plain;
  plain.materials = {{"white", scene::Lambertian{{1, 1, 1}}}};
  plain.spheres = {{{0, 0, -2}, 1, 0, ""}};
  const AxisPlan few = plan_of(plain);
  EXPECT_FALSE(has_axis(few, "fresnel"));
  EXPECT_FALSE(has_axis(few, "roulette"));
  EXPECT_NE(std::find(few.left_out.begin(), few.left_out.end(), "no glass: no Fresnel axis"), few.left_out.end());
  plain.spheres = {};
  EXPECT_FALSE(has_axis(plan_of(plain), "depth"));
}

class StudyRun : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder = new support::ScratchFolder;
    std::ofstream(*folder / "scene.toml")
        << "[image]\nwidth = 160\nheight = 90\n[camera]\nlook_from = [0, 1, 4]\n"
           "look_at = [0, 0.3, 0]\nvfov = 40\n[render]\nsamples = 50\n"
           "[material]\nground = { type = \"lambertian\", albedo = [0.5, 0.5, 0.5] }\n"
           "glass = { type = \"dielectric\" }\n"
           "[[sphere]]\ncenter = [0, -100, 0]\nradius = 100\nmaterial = \"ground\"\n"
           "[[sphere]]\ncenter = [0, 0.5, 0]\nradius = 0.5\nmaterial = \"glass\"\n";
    Request request;
    request.scene = *folder / "scene.toml";
    request.budget_s = 12;
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
  static support::ScratchFolder* folder;
  static Study* study;
};
support::ScratchFolder* StudyRun::folder = nullptr;
Study* StudyRun::study = nullptr;

TEST_F(StudyRun, KeepsToItsBudget) { EXPECT_LT(study->seconds, 20); }

TEST_F(StudyRun, TellsBiasFromNoise) {
  // One scattering event is not enough for glass; sixteen times the samples is a quarter of the noise.
  EXPECT_GT(point("depth", "at most 1").bias, 0.02);
  EXPECT_LT(point("depth", "at most 1").energy, -0.005);
  EXPECT_LT(point("precision", "fast").bias, 0.005);
  EXPECT_NEAR(point("sampler", "16 independent").noise / point("sampler", "256 independent").noise, 4, 0.8);
  EXPECT_LT(point("samples", "64 sobol").error, point("sampler", "64 independent").error);
}

TEST_F(StudyRun, TheFrontIsWhatNothingBeats) {
  for (const Point& p : study->points) {
    if (!p.on_front) continue;
    for (const Point& other : study->points)
      EXPECT_FALSE(other.axis != "accelerator" && other.seconds < p.seconds && other.error < p.error)
          << p.name << " is beaten by " << other.name;
  }
}

TEST_F(StudyRun, FilesAreAsLossyAsTheyAre) {
  for (const FilePoint& f : study->files) {
    if (f.name == "float zip") {
      EXPECT_EQ(f.error, 0);
    }
    if (f.name == "half zip") {
      EXPECT_LT(f.error, 5e-4);
    }
    if (f.name == "half dwaa") {
      EXPECT_GT(f.error, 5e-4);
    }
    EXPECT_GT(f.bytes, 0u);
  }
}

TEST_F(StudyRun, RecommendsACommand) {
  const Recommendation& r = study->recommendation;
  EXPECT_EQ(r.command.rfind("orrery render " + (*folder / "scene.toml").string() + " -o final.exr --noise 0.02", 0), 0u)
      << r.command;
  EXPECT_GT(r.seconds, 0);
  EXPECT_LE(r.noise, 0.02);
  EXPECT_GT(r.baseline_seconds, 0);
}

TEST_F(StudyRun, JsonAndPageHoldIt) {
  const auto json = nlohmann::json::parse(study_json(*study));
  EXPECT_EQ(json["schema"], "orrery.study/1");
  EXPECT_EQ(json["points"].size(), study->points.size());
  EXPECT_EQ(json["features"].size(), 3u);
  const std::string page = study_html(*study);
  EXPECT_EQ(page.find("{{DATA}}"), std::string::npos);
  EXPECT_NE(page.find("data:image/jpeg;base64,"), std::string::npos);
  EXPECT_EQ(page.find("https://"), std::string::npos) << "it must be readable without a network";
  const auto begin = page.find("type=\"application/json\">") + 24;
  const auto data = nlohmann::json::parse(page.substr(begin, page.find("</script>", begin) - begin));
  EXPECT_EQ(data["points"].size(), study->points.size());
  EXPECT_NE(study_text(*study).find("* nothing measured is both quicker and better"), std::string::npos);
}

TEST_F(StudyRun, TooSmallABudgetSaysWhatItNeeds) {
  Request request;
  request.scene = *folder / "scene.toml";
  request.budget_s = 0.05;
  try {
    run_study(request);
    FAIL();
  } catch (const base::Error& error) {
    EXPECT_EQ(error.kind(), base::ErrorKind::kUsage);
    EXPECT_NE(std::string(error.what()).find("--budget is too small for this scene: a study needs "),
              std::string::npos);
  }
}

}  // namespace
}  // namespace orrery::study
