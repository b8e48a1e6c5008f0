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

/// A value of the key's type, inside its range, that is no key's default.
template <class Target>
Value other_value(const Key<Target>& key) {
  switch (key.type) {
    case ValueType::kInteger: return std::int64_t{7};
    case ValueType::kNumber: return 0.375;
    case ValueType::kVector: return Vec3d{0.125, 0.375, 0.625};
    case ValueType::kText:
    case ValueType::kName: return std::string("other");
    case ValueType::kInterval: return Interval{0.25, 0.75};
    case ValueType::kChoice: return key.choices.back();
    case ValueType::kWindow: return Window{1, 2, 3, 4};
    case ValueType::kBoolean: return false;
    case ValueType::kChoices: return std::vector<std::string>{key.choices.back(), key.choices.front()};
    case ValueType::kTexts: return std::vector<std::string>{"x > 0: 0.375"};
    case ValueType::kNumbersByType: return NumbersByType{{"1", 0.375}};
    case ValueType::kColorsByType: return ColorsByType{{"1", {0.125, 0.375, 0.625}}};
  }
  return {};
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

TEST(SceneSchema, EachPointsKeySetsItsOwnMemberAndNoOther) {
  const PointsKeys defaults;
  for (const auto& key : points_keys()) {
    PointsKeys points;
    key.set(points, key.type == ValueType::kBoolean ? Value(true) : other_value(key));
    for (const auto& other : points_keys())
      EXPECT_EQ(other.text(points) == other.text(defaults), &other != &key) << key.name << " and " << other.name;
  }
}

TEST(SceneSchema, EachMaterialKeySetsItsOwnMember) {
  for (const MaterialType& type : material_types()) {
    for (const auto& key : type.keys) {
      MaterialModel model = type.model;
      key.set(model, other_value(key));
      for (const auto& other : type.keys)
        EXPECT_EQ(other.text(model) == other.text(type.model), &other != &key) << type.name << "." << key.name;
    }
  }
}

TEST(SceneSchema, MaterialTypesAreInVariantOrder) {
  ASSERT_EQ(material_types().size(), std::variant_size_v<MaterialModel>);
  for (std::size_t i = 0; i < material_types().size(); ++i) EXPECT_EQ(material_types()[i].model.index(), i);
}

TEST(SceneSchema, TextureTypesAreInTheOrderOfTheirEnumeration) {
  for (const TextureUse use : {TextureUse::kReflectance, TextureUse::kRadiance, TextureUse::kNumber}) {
    const auto& types = texture_types(use);
    ASSERT_EQ(types.size(), 5u);
    for (std::size_t i = 0; i < types.size(); ++i) EXPECT_EQ(static_cast<std::size_t>(types[i].type), i);
  }
}

TEST(SceneSchema, EachTextureKeySetsItsOwnMember) {
  for (const TextureUse use : {TextureUse::kReflectance, TextureUse::kRadiance, TextureUse::kNumber}) {
    for (const TextureTypeKeys& type : texture_types(use)) {
      for (const auto& key : type.keys) {
        Texture texture;
        key.set(texture, other_value(key));
        for (const auto& other : type.keys)
          EXPECT_EQ(other.text(texture) == other.text(Texture{}), &other != &key) << type.name << "." << key.name;
      }
    }
  }
}

TEST(SceneSchema, TexturedKeysAreKeysOfTheirType) {
  for (const MaterialType& type : material_types()) {
    for (const TexturedKey& textured : type.textured) {
      const auto is_it = [&](const auto& key) { return key.name == textured.name; };
      EXPECT_TRUE(std::any_of(type.keys.begin(), type.keys.end(), is_it)) << type.name << "." << textured.name;
      MaterialModel model = type.model;
      EXPECT_EQ(textured.get(model), nullptr);
      textured.at(model) = std::make_shared<const Texture>();
      for (const TexturedKey& other : type.textured)
        EXPECT_EQ(other.get(model) != nullptr, &other == &textured) << type.name << "." << textured.name;
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
