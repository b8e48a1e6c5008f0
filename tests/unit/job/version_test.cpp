// SPDX-License-Identifier: Apache-2.0
#include "job/version.h"

#include <gtest/gtest.h>

#include <cctype>

namespace orrery::job {
namespace {

TEST(JobVersion, EveryLibraryHasAVersion) {
  EXPECT_TRUE(std::isdigit(program_version()[0])) << program_version();
  EXPECT_EQ(library_versions().size(), 8u);
  for (const auto& [name, version] : library_versions()) {
    EXPECT_TRUE(std::isdigit(version[0])) << name << " " << version;
    EXPECT_NE(version.find('.'), std::string::npos) << name << " " << version;
  }
}

}  // namespace
}  // namespace orrery::job
