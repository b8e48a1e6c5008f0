// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>

#include <nlohmann/json.hpp>

#include "study/study.h"

namespace orrery::study {
namespace {

Study with_a_warning() {
  Study study;
  study.warnings = {"exact: the times differ"};
  return study;
}

TEST(StudyReport, WarningsAreInTextAndJson) {
  EXPECT_NE(study_text(with_a_warning()).find("exact: the times differ"), std::string::npos);
  const auto json = nlohmann::json::parse(study_json(with_a_warning()));
  EXPECT_EQ(json["warnings"].size(), 1u);
}

}  // namespace
}  // namespace orrery::study
