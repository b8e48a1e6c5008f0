// SPDX-License-Identifier: Apache-2.0
#include "view/picker.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "support/small_view.h"
#include "view/viewer.h"

namespace orrery::view {
namespace {

using namespace std::chrono_literals;

TEST(ViewPicker, ASphereIsPicked) {
  Viewer viewer(subject_of, {}, {});
  finished(viewer);
  const std::optional<Picked> picked = viewer.pick(0.5, 0.5);
  ASSERT_TRUE(picked);
  EXPECT_EQ(picked->title, "sphere[0]");
  EXPECT_EQ(picked->center, (math::Vec3d{0, 0, 0}));
  EXPECT_EQ(picked->radius, 1);
  EXPECT_EQ(picked->values, (std::vector<std::pair<std::string, std::string>>{{"material", "grey"}}));
  EXPECT_FALSE(viewer.pick(0, 0)) << "the background";
}

TEST(ViewPicker, PicksMayComeAtAnyTime) {
  Viewer viewer(subject_of, {}, {});
  std::atomic<bool> ends{false};
  std::thread client([&] {
    while (!ends) {
      const std::optional<Picked> picked = viewer.pick(0.5, 0.5);
      EXPECT_EQ(picked ? picked->title : "sphere[0]", "sphere[0]");
    }
  });
  for (int i = 0; i < 30; ++i) {  // other spheres, thus another BVH
    Wish wish;
    wish.options["--set"] = {"sphere[0].radius=" + std::to_string(1 + 0.01 * i)};
    const std::uint64_t number = viewer.ask(wish);
    while (viewer.state().served < number) viewer.frame(1000000, 1ms);
    EXPECT_EQ(viewer.state().problem, "");
  }
  ends = true;
  client.join();
}

TEST(ViewPicker, ARodIsPicked) {
  const auto make = [](const std::vector<std::string>& words) {
    Subject out = subject_of(words);
    out.job.scene.text = std::make_shared<const std::string>(
        std::string(kScene) +
        "[[rod]]\nfrom = [-1, 0, 1.5]\nto = [1, 1, 1.5]\nradius = 0.3\nmaterial = \"grey\"\nname = \"bond\"\n");
    return out;
  };
  Viewer viewer(make, {}, {});
  finished(viewer);
  ASSERT_EQ(viewer.state().problem, "");
  const std::optional<Picked> picked = viewer.pick(0.5, 0.4);
  ASSERT_TRUE(picked);
  EXPECT_EQ(picked->title, "rod[0]");
  EXPECT_EQ(picked->center, (math::Vec3d{0, 0.5, 1.5}));
  EXPECT_EQ(picked->radius, 0.3);
  const std::vector<std::pair<std::string, std::string>> values = {{"name", "bond"},
                                                                   {"ends", "[-1, 0, 1.5], [1, 1, 1.5]"}};
  EXPECT_EQ(picked->values, values);
}

TEST(ViewPicker, APickedBondTellsItsTwoParticles) {
  const std::filesystem::path file = testing::TempDir() + "view_bonds.xyz";
  std::ofstream(file) << "4\n\nHe 9 9 0\nC -2 0 0\nC 2 0 0\nO 2 3 0\n";
  const auto make = [&](const std::vector<std::string>& words) {
    Subject out = subject_of(words);
    out.job.scene.file = file.parent_path() / "scene.toml";
    out.job.scene.text = std::make_shared<const std::string>(
        std::string(kScene).substr(0, std::string(kScene).find("[[sphere]]")) +
        "[[rod]]\nfrom = [9, 9, 9]\nto = [9, 9, 9]\nradius = 1\nmaterial = \"grey\"\n[[points]]\nfile = \"" +
        file.filename().string() +
        "\"\nmaterial = \"grey\"\nradius = 0.5\nbonds = { length = 4.5, radius = 0.3 }\nselect = \"element != "
        "'He'\"\n");
    return out;
  };
  Viewer viewer(make, {}, {});
  finished(viewer);
  const std::optional<Picked> picked = viewer.pick(0.5, 0.5);
  ASSERT_TRUE(picked) << viewer.state().problem;
  EXPECT_EQ(picked->title, "bond of rows 2 and 3 of view_bonds.xyz");
  EXPECT_EQ(picked->radius, 0.3);
  ASSERT_GE(picked->values.size(), 2u);
  EXPECT_EQ(picked->values[0], (std::pair<std::string, std::string>{"element", "C, C"}));
  EXPECT_EQ(picked->values[1], (std::pair<std::string, std::string>{"x", "-2, 2"}));
}

TEST(ViewPicker, APickedParticleHasTheColumnsOfItsRow) {
  const std::filesystem::path file = testing::TempDir() + "view_particles.xyz";
  std::ofstream(file) << "3\nProperties=species:S:1:pos:R:3:charge:R:1\n"
                         "He -2 0 0 0.1\nNe 0 0 0 -0.25\nAr 2 0 0 0.3\n";
  const auto make = [&](const std::vector<std::string>& words) {
    Subject out = subject_of(words);
    out.job.scene.file = file.parent_path() / "scene.toml";
    out.job.scene.text = std::make_shared<const std::string>(
        std::string(kScene).substr(0, std::string(kScene).find("[[sphere]]")) + "[[points]]\nfile = \"" +
        file.filename().string() + "\"\nmaterial = \"grey\"\nradius = 0.5\nselect = \"species != 'He'\"\n");
    return out;
  };
  Viewer viewer(make, {}, {});
  finished(viewer);
  const std::optional<Picked> picked = viewer.pick(0.5, 0.5);
  ASSERT_TRUE(picked) << viewer.state().problem;
  EXPECT_EQ(picked->title, "row 2 of view_particles.xyz");
  EXPECT_EQ(picked->center, (math::Vec3d{0, 0, 0}));
  const std::vector<std::pair<std::string, std::string>> values = {
      {"species", "Ne"}, {"x", "0"}, {"y", "0"}, {"z", "0"}, {"charge", "-0.25"}};
  EXPECT_EQ(picked->values, values);
  // The file is not needed again while nothing but the camera changes.
  std::filesystem::remove(file);
  EXPECT_TRUE(viewer.pick(0.5, 0.5));
}

TEST(ViewPicker, TheBoundsAreThoseOfTheCenters) {
  Viewer viewer(subject_of, {}, {{{"--set", {"sphere[0].center=[1, 2, 3]"}}}});
  finished(viewer);
  const auto bounds = viewer.state().bounds;
  ASSERT_TRUE(bounds);
  EXPECT_EQ((*bounds)[0], (math::Vec3d{1, 2, 3}));
  EXPECT_EQ((*bounds)[1], (math::Vec3d{1, 2, 3}));
}

}  // namespace
}  // namespace orrery::view
