// SPDX-License-Identifier: Apache-2.0
#include "study/recommendation.h"

#include <gtest/gtest.h>

#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "study/study.h"
#include "study/study_renderer.h"
#include "support/everything.h"

namespace orrery::study {
namespace {

Point point(const std::string& axis, const std::string& name, double samples, double seconds, double error) {
  Point p;
  p.axis = axis;
  p.name = name;
  p.samples = samples;
  p.seconds = seconds;
  p.error = p.measured.noise = error;
  return p;
}

/// A recommendation for 1 % noise, without a test at full resolution.
class StudyRecommendation : public testing::Test {
 protected:
  StudyRecommendation() {
    study_.scene = "a.toml";
    study_.width = full_.width;
    study_.height = full_.height;
    study_.points = {point("samples", "16 sobol", 16, 2, 0.01), point("sampler", "64 independent", 64, 8, 0.01),
                     point("precision", "exact", 64, 8, 0.005), point("precision", "fast", 64, 4, 0.005)};
  }

  const Recommendation& recommendation() {
    Request request;
    request.budget_s = 0;
    StudyRenderer renderer(request, 1);
    study_.recommendation = {};
    recommend(request, full_, 1e6, renderer, study_);
    return study_.recommendation;
  }

  Point& independent() { return study_.points[1]; }
  Point& fast() { return study_.points[3]; }

 private:
  compile::CompiledScene full_ = compile::compile(test::everything());
  Study study_;
};

TEST_F(StudyRecommendation, ShowsTheTimeOfTheBaselineAndASignificantBias) {
  fast().bias = 0.0005;
  const Recommendation& r = recommendation();
  EXPECT_EQ(r.words, "for 1 % noise: --noise 0.01 --precision fast, 2 s instead of 8 s, bias 0.05 %");
  EXPECT_EQ(r.bias, 0.0005);
}

TEST_F(StudyRecommendation, ShowsNoBiasThatIsNotSignificant) {
  fast().measured.energy = 0.01;
  const Recommendation& r = recommendation();
  EXPECT_EQ(r.words, "for 1 % noise: --noise 0.01 --precision fast, 2 s instead of 8 s");
  EXPECT_EQ(r.bias, 0);
}

TEST_F(StudyRecommendation, HasTheSamplesOfTheBaselineIfThatIsFaster) {
  independent().error = 0.0025;
  const Recommendation& r = recommendation();
  EXPECT_EQ(r.words, "for 1 % noise: --samples 4, 0.5 s");
  EXPECT_EQ(r.command, "orrery render a.toml -o final.exr --samples 4");
  EXPECT_EQ(r.samples, 4);
  EXPECT_EQ(r.seconds, r.baseline_seconds);
}

TEST_F(StudyRecommendation, TheBaselineHasAtLeastOneSample) {
  independent().error = 1e-6;
  EXPECT_EQ(recommendation().baseline_seconds, 8.0 / 64);
  EXPECT_EQ(recommendation().samples, 1);
}

}  // namespace
}  // namespace orrery::study
