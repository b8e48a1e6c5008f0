// SPDX-License-Identifier: Apache-2.0
#include "job/version.h"

#include <gtest/gtest.h>

#include <regex>

namespace orrery::job {
namespace {

TEST(JobVersion, EveryLibraryHasOne) {
  const std::regex version(R"(\d+(\.\d+)+.*)");
  EXPECT_TRUE(std::regex_match(program_version(), version)) << program_version();
  EXPECT_EQ(library_versions().size(), 8u);
  for (const auto& [name, text] : library_versions())
    EXPECT_TRUE(std::regex_match(text, version)) << name << ' ' << text;
}

}  // namespace
}  // namespace orrery::job
