// SPDX-License-Identifier: Apache-2.0
#include "compare/color_view.h"

#include <gtest/gtest.h>

namespace orrery::compare {
namespace {

TEST(CompareFalseColor, GoesFromBlackToPaleYellow) {
  const film::Picture p = false_color({3, 1, {0, 0.05f, 7}}, 0.1);
  EXPECT_LT(p.find("R")->values[0], 0.01f);
  EXPECT_NEAR(p.find("R")->values[1], 0.716, 1e-3);
  EXPECT_NEAR(p.find("G")->values[2], 0.991, 1e-3);
}

}  // namespace
}  // namespace orrery::compare
