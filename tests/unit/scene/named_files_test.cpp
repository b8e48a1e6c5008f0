// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <memory>

#include "scene/scene.h"
#include "scene/schema.h"
#include "scene/texture.h"
#include "support/mentions.h"

namespace orrery::scene {
namespace {

/// A scene that names a file of every role, and names that are not of files.
Scene scene_with_files() {
  Scene s;
  s.color.config = "a.ocio";
  s.background.file = "b.exr";
  Texture image, checker;
  image.type = TextureType::kImage;
  image.file = "c.png";
  s.materials = {{"d.png", Lambertian{{}, std::make_shared<const Texture>(image)}},
                 {"e", Metal{{}, 0, std::make_shared<const Texture>(checker), nullptr}}};
  s.points.resize(2);
  s.points[0].file = "f.ply";
  s.points[0].color.map = "g.txt";
  s.points[1].file = "h.ply";
  return s;
}

TEST(SceneNamedFiles, AreThoseOfAllKeys) {
  std::string found;
  for (const NamedFile& file : named_files(scene_with_files()))
    found += std::string(file.role->name) + " " + file.name + "; ";
  EXPECT_TRUE(test::mentions(found, {"b.exr", "a.ocio", "c.png", "f.ply"}));
}

TEST(SceneNamedFiles, AreRenamed) {
  Scene s = scene_with_files();
  rename_files(s, [](const NamedFile& file) { return "../" + file.name; });
  for (const NamedFile& file : named_files(s)) EXPECT_TRUE(file.name.starts_with("../")) << file.name;
  EXPECT_EQ(named_files(s).size(), 6u);
  EXPECT_EQ(s.points[1].color.map, "viridis");
  EXPECT_EQ(s.materials[0].name, "d.png");
}

TEST(SceneNamedFiles, NamesOfBuiltInThingsAreNotFiles) {
  Scene s;
  s.points.resize(1);
  s.color.config = "ocio://default";
  EXPECT_TRUE(named_files(s).empty());
}

}  // namespace
}  // namespace orrery::scene
