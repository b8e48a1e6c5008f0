// SPDX-License-Identifier: Apache-2.0
#include "view/wish.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace orrery::view {
namespace {

TEST(ViewWish, ValuesAreStringsListsOrFlags) {
  const auto is_control = [](const std::string&) { return true; };
  const Wish wish = read_wish(
      R"({"options": {"--set": ["a=1", "b=2"], "--style": "", "--box": true, "--map": "fast", "--slice": []}})",
      is_control);
  EXPECT_EQ(words_of({"--frame", "3"}, wish),
            (std::vector<std::string>{"--frame", "3", "--box", "--map", "fast", "--set", "a=1", "--set", "b=2"}));
}

}  // namespace
}  // namespace orrery::view
