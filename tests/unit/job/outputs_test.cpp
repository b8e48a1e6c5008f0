// SPDX-License-Identifier: Apache-2.0
#include "job/outputs.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "base/error.h"

namespace orrery::job {
namespace {

/// The error message for these files; empty: none.
std::string verdict(const std::vector<std::filesystem::path>& pictures, int bits = 0) {
  try {
    check_bits({pictures.begin(), pictures.end()}, bits);
  } catch (const base::Error& error) {
    EXPECT_EQ(error.kind(), base::ErrorKind::kUsage);
    return error.what();
  }
  return {};
}

TEST(JobOutputs, UnknownExtensionsAreUsageErrors) { EXPECT_NE(verdict({"a.png", "a.webp"}), ""); }

TEST(JobOutputs, BitsMustFitTheFormat) {
  EXPECT_EQ(verdict({"a.png", "a.exr"}, 16), "");
  EXPECT_NE(verdict({"a.png", "a.jpg"}, 16).find("a.jpg holds 8 bits"), std::string::npos);
}

}  // namespace
}  // namespace orrery::job
