// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>

#include <nlohmann/json.hpp>

#include "study/study.h"

namespace orrery::study {
namespace {

Study with_features() {
  Study study;
  study.features = {{"thin lens", true}, {"textures", false, 0.05, 0.02, 0.07}, {"lights", false, 0.1, -0.493, 0.2}};
  study.warnings = {"exact: the times differ"};
  return study;
}

TEST(StudyReport, AFeatureWhoseIntervalContainsZeroHasNoMeasurableCost) {
  const std::string text = study_text(with_features());
  EXPECT_NE(text.find("thin lens: required"), std::string::npos) << text;
  EXPECT_NE(text.find("textures: not required, omitting it saves 5.0 % of the time (2.0 .. 7.0 %)"), std::string::npos)
      << text;
  EXPECT_NE(text.find("lights: not required, no measurable cost (-49.3 .. 20.0 % of the time)"), std::string::npos)
      << text;
}

TEST(StudyReport, WarningsAreInTextAndJson) {
  EXPECT_NE(study_text(with_features()).find("exact: the times differ"), std::string::npos);
  const auto json = nlohmann::json::parse(study_json(with_features()));
  EXPECT_EQ(json["warnings"].size(), 1u);
  EXPECT_TRUE(json["features"][0]["saves"].is_null());
  EXPECT_EQ(json["features"][1]["greatest"], 0.07);
}

}  // namespace
}  // namespace orrery::study
