// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <variant>

#include "scene/schema.h"
#include "scene/texture.h"
#include "unit/scene/other_value.h"

namespace orrery::scene {
namespace {

TEST(SceneMaterialKeys, EachMaterialKeySetsItsOwnMember) {
  for (const MaterialType& type : material_types()) {
    for (const auto& key : type.keys) {
      MaterialModel model = type.model;
      key.set(model, other_value(key));
      for (const auto& other : type.keys)
        EXPECT_EQ(other.text(model) == other.text(type.model), &other != &key) << type.name << "." << key.name;
    }
  }
}

TEST(SceneMaterialKeys, MaterialTypesAreInVariantOrder) {
  ASSERT_EQ(material_types().size(), std::variant_size_v<MaterialModel>);
  for (std::size_t i = 0; i < material_types().size(); ++i) EXPECT_EQ(material_types()[i].model.index(), i);
}

TEST(SceneMaterialKeys, TexturedKeysAreKeysOfTheirType) {
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

}  // namespace
}  // namespace orrery::scene
