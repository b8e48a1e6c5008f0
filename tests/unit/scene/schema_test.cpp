// SPDX-License-Identifier: Apache-2.0
#include "scene/schema.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>

#include "scene/texture.h"
#include "support/mentions.h"
#include "unit/scene/other_value.h"

namespace orrery::scene {
namespace {

const Key<Scene>& key_of(std::string_view table_name, std::string_view name) {
  for (const Table& table : tables())
    for (const auto& key : table.keys)
      if (table.name == table_name && key.name == name) return key;
  throw std::out_of_range(std::string(table_name) + "." + std::string(name));
}

bool has_range(ValueType type) {
  return type == ValueType::kInteger || type == ValueType::kNumber || type == ValueType::kVector;
}

// Catches two keys that share a member by mistake, and setters that set nothing.
TEST(SceneSchema, EachKeySetsItsOwnMemberAndNoOther) {
  for (const Table& table : tables()) {
    for (const auto& key : table.keys) {
      Scene scene;
      const bool is_off = key.type == ValueType::kBoolean && key.text(scene) == "false";
      key.set(scene, is_off ? Value(true) : other_value(key));
      const Scene defaults;
      for (const Table& other_table : tables())
        for (const auto& other : other_table.keys)
          EXPECT_EQ(other.text(scene) == other.text(defaults), &other != &key)
              << table.name << "." << key.name << " and " << other_table.name << "." << other.name;
    }
  }
}

TEST(SceneSchema, DefaultsAreInsideTheirOwnRange) {
  const auto inside = [](const Range& range, std::string text) {
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c == '[' || c == ',' || c == ']'; }, ' ');
    std::istringstream numbers(text);
    for (double x = 0; numbers >> x;)
      if (!range.contains(x)) return false;
    return true;
  };
  const Scene scene;
  for (const Table& table : tables())
    for (const auto& key : table.keys)
      EXPECT_TRUE(!has_range(key.type) || inside(key.range, key.text(scene))) << key.name << " = " << key.text(scene);
  for (const MaterialType& type : material_types())
    for (const auto& key : type.keys)
      EXPECT_TRUE(!has_range(key.type) || inside(key.range, key.text(type.model))) << type.name << "." << key.name;
}

TEST(SceneSchema, EachKeyIsDocumented) {
  for (const Table& table : tables())
    for (const auto& key : table.keys) EXPECT_FALSE(key.doc.empty()) << table.name << "." << key.name;
}

TEST(SceneSchema, RangesAreAsSpecified) {
  EXPECT_FALSE(key_of("camera", "vfov").range.contains(0));
  EXPECT_FALSE(key_of("camera", "vfov").range.contains(180));
  EXPECT_TRUE(key_of("camera", "vfov").range.contains(179.99));
  EXPECT_TRUE(key_of("camera", "defocus_angle").range.contains(0));
  EXPECT_FALSE(key_of("camera", "defocus_angle").range.contains(180));
  EXPECT_FALSE(key_of("camera", "focus_distance").range.contains(0));
  EXPECT_FALSE(key_of("image", "width").range.contains(0));
  EXPECT_TRUE(key_of("image", "height").range.contains(65536));
  EXPECT_FALSE(key_of("image", "height").range.contains(65537));
  EXPECT_FALSE(key_of("render", "samples").range.contains(0));
  EXPECT_FALSE(key_of("render", "max_depth").range.contains(0));
  EXPECT_TRUE(key_of("render", "max_depth").range.contains(1));
  EXPECT_FALSE(key_of("render", "max_depth").range.contains(10001));
  EXPECT_TRUE(key_of("render", "seed").range.contains(4294967295.0));
  EXPECT_FALSE(key_of("render", "seed").range.contains(4294967296.0));
  EXPECT_FALSE(key_of("background", "top").range.contains(-1e-9));
}

TEST(SceneSchema, EveryRangeRejectsNaN) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Table& table : tables())
    for (const auto& key : table.keys) EXPECT_FALSE(has_range(key.type) && key.range.contains(nan)) << key.name;
}

TEST(SceneSchema, FormatsRanges) {
  EXPECT_EQ((Range{0, 1}).text(), "0..1");
  EXPECT_EQ((Range{0, 180, true, true}).text(), "above 0 and below 180");
  EXPECT_EQ((Range{0, 180, false, true}).text(), "at least 0 and below 180");
  EXPECT_EQ((Range{0, 5, true, false}).text(), "above 0 and at most 5");
  EXPECT_TRUE(test::mentions((Range{0, 5, true, false}).requirement(), {"above", "0", "5"}));
  EXPECT_EQ((Range{0, 5}).requirement(), "must be in 0..5");
}

TEST(SceneSchema, FocusDistanceDefaultsToTheDistanceToLookAt) {
  Scene scene;
  const auto& key = key_of("camera", "focus_distance");
  EXPECT_EQ(key.text(scene), "distance to look_at");
  EXPECT_FALSE(scene.camera.focus_distance.has_value()) << "reading must not set it";
  key.set(scene, Value(10.0));
  EXPECT_EQ(scene.camera.focus_distance, 10.0);
}

TEST(SceneSchema, ChoicesAreInEnumeratorOrder) {
  Scene scene;
  key_of("render", "precision").set(scene, Value(std::string("book")));
  key_of("render", "shading").set(scene, Value(std::string("normal")));
  key_of("render", "accelerator").set(scene, Value(std::string("list")));
  key_of("background", "type").set(scene, Value(std::string("constant")));
  EXPECT_EQ(scene.render.precision, Precision::kBook);
  EXPECT_EQ(scene.render.shading, Shading::kNormal);
  EXPECT_EQ(scene.render.accelerator, Accelerator::kList);
  EXPECT_EQ(scene.background.type, BackgroundType::kConstant);
  MaterialModel glass = Dielectric{};
  for (const auto& key : material_types()[3].keys)
    if (key.name == "fresnel") key.set(glass, Value(std::string("none")));
  EXPECT_EQ(std::get<Dielectric>(glass).fresnel, Fresnel::kNone);
}

}  // namespace
}  // namespace orrery::scene
