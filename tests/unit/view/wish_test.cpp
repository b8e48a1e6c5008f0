// SPDX-License-Identifier: Apache-2.0
#include "view/wish.h"

#include <gtest/gtest.h>

#include <set>
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

TEST(ViewWish, SettingsThatMayNameFilesAreKnown) {
  for (const char* setting : {"background.file=a.exr", "color.config=a.ocio", "points[0].file=a.csv",
                              "rods[0].file=a.csv", "points[0].color.map=a.txt", "material.a.albedo.file=a.png",
                              "material.a.fuzz={file=\"a\"}", "points=[{file=\"a\"}]"}) {
    load::Overrides overrides;
    overrides.add(setting);
    EXPECT_EQ(named_files(overrides).size(), 1u) << setting;
  }
  load::Overrides other;
  other.add("camera.vfov=30");
  other.add("background.color=[1, 1, 1]");
  EXPECT_EQ(named_files(other), std::set<std::string>());
}

}  // namespace
}  // namespace orrery::view
