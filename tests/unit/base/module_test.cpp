// SPDX-License-Identifier: Apache-2.0
#include "base/module.h"

#include <gtest/gtest.h>

#include "base/error.h"

namespace orrery::base {
namespace {

TEST(BaseModule, MissingModuleIsAnInternalErrorThatNamesTheFile) {
  try {
    load_module("cellar");
    FAIL() << "loaded";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kInternal);
    EXPECT_NE(std::string(error.what()).find("/orrery-cellar.so"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace orrery::base
