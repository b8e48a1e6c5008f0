// SPDX-License-Identifier: Apache-2.0
// Target noise, time budgets, and studies.
#include <nlohmann/json.hpp>

#include "cli/program.h"

namespace orrery::test {
namespace {

class CliTrade : public ProgramTest {
 protected:
  nlohmann::json stats() { return nlohmann::json::parse(text_of(folder_ / "s.json")); }
};

TEST_F(CliTrade, TargetNoiseOverridesTheScenesSampleCount) {
  const Outcome r = run("render good.toml -o a.exr --noise 0.002 --stats s.json --progress none");
  EXPECT_EQ(r.status, 0);
  EXPECT_NE(r.err.find("; noise 0.00"), std::string::npos) << r.err;
  const auto s = stats();
  EXPECT_LE(s["noise"], 0.002);
  EXPECT_EQ(s["ended_by"], "noise");
  EXPECT_EQ(s["target_missed"], "");
  EXPECT_GT(s["samples_most"], s["samples_fewest"]);
}

TEST_F(CliTrade, MissedTargetNoiseIsReported) {
  const Outcome r = run("render good.toml -o a.exr --noise 0.0001 --samples 32 --stats s.json --progress none");
  EXPECT_EQ(r.status, 0);
  EXPECT_NE(r.err.find("warning: noise 0.00"), std::string::npos) << r.err;
  EXPECT_NE(r.err.find(" instead of 0.0001: "), std::string::npos);
  EXPECT_NE(stats()["target_missed"], "");
  const Outcome strict = run("render good.toml -o b.exr --noise 0.0001 --samples 32 --strict --stats s.json -q");
  EXPECT_EQ(strict.status, 76);
  EXPECT_EQ(stats()["exit_status"], 76);
  EXPECT_EQ(strict.err.rfind("orrery: noise 0.00", 0), 0u) << strict.err;
  // The image is written nevertheless, with the same pixels.
  EXPECT_EQ(run("compare a.exr b.exr --fail-above max=0 -q").status, 0);
}

TEST_F(CliTrade, AnImageThatMissesItsTargetIsUpToDateUnlessStrict) {
  const std::string command = "render good.toml -o a.exr -o a.png --noise 0.0001 --samples 32 --skip-existing ";
  EXPECT_EQ(run(command + "--strict -q").status, 76);
  EXPECT_EQ(run(command + "--strict -q").status, 76);
  const Outcome lenient = run(command);
  EXPECT_EQ(lenient.status, 0);
  EXPECT_TRUE(contains(lenient.err, "skipped")) << lenient.err;
  const std::string met = "render good.toml -o b.exr --noise 0.5 --skip-existing --strict";
  EXPECT_EQ(run(met).status, 0);
  EXPECT_TRUE(contains(run(met).err, "skipped"));
}

TEST_F(CliTrade, PixelsWithoutNoiseEstimateAreReported) {
  // One path in a thousand finds light: with 64 samples nearly all pixels are black.
  write(
      "dark.toml",
      "[image]\nwidth = 24\nheight = 14\n"
      "[camera]\nlook_from = [0, 0, 0]\nlook_at = [0.3, 0.2, -1]\nvfov = 60\n"
      "[background]\ntype = \"constant\"\ncolor = [5, 5, 5]\n"
      "[material.wall]\ntype = \"lambertian\"\nalbedo = [0.5, 0.5, 0.5]\n" +
          [] {
            std::string spheres;
            for (const char* center : {"4.8, 0, 0", "-4.8, 0, 0", "0, 4.8, 0", "0, -4.8, 0", "0, 0, 4.8", "0, 0, -4.8"})
              spheres += std::string("[[sphere]]\nradius = 3.9\nmaterial = \"wall\"\ncenter = [") + center + "]\n";
            return spheres;
          }());
  const Outcome r = run("render dark.toml -o a.exr --noise 0.3 --samples 64 --stats s.json --progress none");
  EXPECT_EQ(r.status, 0);
  EXPECT_NE(r.err.find("warning: "), std::string::npos) << r.err;
  EXPECT_NE(r.err.find(" pixels cannot be estimated"), std::string::npos) << r.err;
  const auto s = stats();
  EXPECT_GT(s["unreliable_pixels"], 200);
  EXPECT_EQ(s["ended_by"], "samples");
  EXPECT_LE(s["noise_expected"], s["noise"]);
  EXPECT_EQ(run("render dark.toml -o b.exr --noise 0.3 --samples 64 --strict -q").status, 76);
  EXPECT_NE(s["target_missed"], "");
}

TEST_F(CliTrade, TimeBudgetEndsARenderThatMissesItsTargetNoise) {
  // RenderAdaptiveSampling.TimeBudgetIsKept tests the precision of the budget with a clock that counts samples.
  const Outcome r = run("render good.toml -o a.exr --noise 1e-6 --time 0.5s --stats s.json --progress none");
  EXPECT_EQ(r.status, 0);
  EXPECT_NE(r.err.find(" instead of 1e-06: the time budget ended\n"), std::string::npos) << r.err;
  EXPECT_EQ(stats()["ended_by"], "time");
}

TEST_F(CliTrade, InvalidTargetsAreUsageErrors) {
  EXPECT_EQ(run("render good.toml -o a.exr --noise 0").status, 2);
  EXPECT_EQ(run("render good.toml -o a.exr --noise nan").status, 2);
  const Outcome time = run("render good.toml -o a.exr --time 90");
  EXPECT_EQ(time.status, 2);
  EXPECT_NE(time.err.find("must be a time such as 90s, 5m, 1.5h or 1h30m, not `90`"), std::string::npos) << time.err;
  EXPECT_EQ(run("render good.toml -o a.exr --time -5s").status, 2);
  EXPECT_EQ(run("render good.toml -o a.exr --time 1e30h").status, 2);
}

TEST_F(CliTrade, StudyWritesAReport) {
  // A slow machine may need more than the first budget for the minimum that a study measures.
  Outcome r;
  for (const char* budget : {"3s", "60s", "1200s"}) {
    r = run(std::string("study good.toml --noise 0.05 -o report.html --json -q --budget ") + budget);
    if (r.status == 0) break;
  }
  EXPECT_EQ(r.status, 0) << r.err;
  EXPECT_EQ(nlohmann::json::parse(r.out)["schema"], "orrery.study/1");
  EXPECT_NE(text_of(folder_ / "report.html").find("<title>Render time and image error</title>"), std::string::npos);
  EXPECT_EQ(run("study good.toml --budget 0.0001s -q").status, 2);
  EXPECT_EQ(run("study nothing.toml --budget 5s -q").status, 66);
  EXPECT_EQ(run("study good.toml --budget 5s -q -o no/such/place.html").status, 73);
}

}  // namespace
}  // namespace orrery::test
