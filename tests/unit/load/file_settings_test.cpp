// SPDX-License-Identifier: Apache-2.0
#include "load/file_settings.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace orrery::load {
namespace {

TEST(LoadFileSettings, SettingsThatMayNameFilesAreKnown) {
  for (const char* setting : {"background.file=a.exr", "color.config=a.ocio", "points[0].file=a.csv",
                              "rods[0].file=a.csv", "points[0].color.map=a.txt", "material.a.albedo.file=a.png",
                              "material.a.fuzz={file=\"a\"}", "points=[{file=\"a\"}]"}) {
    Overrides overrides;
    overrides.add(setting);
    EXPECT_EQ(named_files(overrides).size(), 1u) << setting;
  }
  Overrides other;
  other.add("camera.vfov=30");
  other.add("background.color=[1, 1, 1]");
  EXPECT_EQ(named_files(other), std::set<std::string>());
}

}  // namespace
}  // namespace orrery::load
