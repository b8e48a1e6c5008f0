// SPDX-License-Identifier: Apache-2.0
#include "scene/texture.h"

#include <gtest/gtest.h>

#include "scene/schema.h"
#include "unit/scene/other_value.h"

namespace orrery::scene {
namespace {

TEST(SceneTexture, TextureTypesAreInTheOrderOfTheirEnumeration) {
  for (const TextureUse use : {TextureUse::kReflectance, TextureUse::kRadiance, TextureUse::kNumber}) {
    const auto& types = texture_types(use);
    ASSERT_EQ(types.size(), 5u);
    for (std::size_t i = 0; i < types.size(); ++i) EXPECT_EQ(static_cast<std::size_t>(types[i].type), i);
  }
}

TEST(SceneTexture, EachTextureKeySetsItsOwnMember) {
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

}  // namespace
}  // namespace orrery::scene
