// SPDX-License-Identifier: Apache-2.0
#include "format/write_tree.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "scene/schema.h"
#include "support/scene_files.h"

namespace orrery::format {
namespace {

using support::SceneFiles;

std::string same(const std::string& file) { return file; }

constexpr const char* kCommentedScene = R"(# a comment
[image]
width = 20
[render]
samples = 3 # another
[material]
zinc = { type = "metal", albedo = [0.1, 0.30000000000000004, 1], fuzz = 1e-7 }
[material."a b"]
type = "lambertian"
albedo = [0.5, 0.5, 0.5]
[[sphere]]
center = [0, 0, -1]
radius = 0.5
material = "a b"
name = "say \"hi\"\n"
[[sphere]]
center = [1, 0, -1]
radius = -0.5
material = "zinc"
[[key]]
target = "camera.vfov"
frames = [1, 2]
values = [30, 40.5]
)";

TEST(FormatWriteTree, ReadsBackToTheSameScene) {
  SceneFiles files;
  const Overrides overrides = {"image.width=33", "material.copper={type=\"metal\",albedo=[1,0,0]}",
                               "sphere[1].radius=0.25", "camera.vfov=30"};
  const std::string text = merged_text("scene.toml", kCommentedScene, overrides, same);
  const scene::Scene a = files.read(kCommentedScene, overrides).scene, b = files.read(text).scene;
  for (const scene::Table& table : scene::tables())
    for (const auto& key : table.keys) EXPECT_EQ(key.text(a), key.text(b)) << key.name;
  ASSERT_EQ(b.materials.size(), 3u);
  for (std::size_t m = 0; m < 3; ++m) {
    EXPECT_EQ(a.materials[m].name, b.materials[m].name) << "points files count materials in the order of the file";
    for (const auto& key : scene::material_types()[a.materials[m].model.index()].keys)
      EXPECT_EQ(key.text(a.materials[m].model), key.text(b.materials[m].model));
  }
  ASSERT_EQ(b.spheres.size(), 2u);
  EXPECT_EQ(b.spheres[0].name, "say \"hi\"\n");
  EXPECT_EQ(b.spheres[1].radius, 0.25);
  EXPECT_EQ(b.spheres[0].material, a.spheres[0].material);
  ASSERT_EQ(b.tracks.size(), 1u);
  EXPECT_EQ(merged_text("scene.toml", text, {}, same), text) << "writing again changes nothing";
}

/// Otherwise the text would have keys that the new type does not have.
TEST(FormatWriteTree, LeavesOutTheKeysOfAReplacedType) {
  SceneFiles files;
  const std::string text = merged_text("scene.toml", kCommentedScene, {"material.zinc.type=dielectric"}, same);
  EXPECT_EQ(text.find("[0.1, 0.30000000000000004, 1]"), std::string::npos) << text;
  EXPECT_EQ(files.read(text).scene.materials[0].model.index(),
            files.read(kCommentedScene, {"material.zinc.type=dielectric"}).scene.materials[0].model.index());
}

TEST(FormatWriteTree, RenamesEveryFileThatTheSceneNames) {
  const std::string text = merged_text("scene.toml", R"(
[color]
config = "a.ocio"
[background]
type = "image"
file = "b.exr"
[[points]]
file = "c.ply"
material = "d.ply"
color = { column = "t", map = "d.txt" }
[[points]]
file = "e.ply"
material = "m"
color = { column = "t", map = "viridis" }
)",
                                       {}, [](const std::string& file) { return "../" + file; });
  for (const char* name :
       {"\"../a.ocio\"", "\"../b.exr\"", "\"../c.ply\"", "\"d.ply\"", "\"../d.txt\"", "\"../e.ply\"", "\"viridis\""})
    EXPECT_NE(text.find(name), std::string::npos) << name << "\n" << text;
}

TEST(FormatWriteTree, RefusesInvalidText) {
  EXPECT_THROW(merged_text("scene.toml", "[image\n", {}, same), base::Error);
  EXPECT_THROW(merged_text("scene.toml", "", {"sphere[2].radius=1"}, same), base::Error);
}

}  // namespace
}  // namespace orrery::format
