// SPDX-License-Identifier: Apache-2.0
#include "scene/texture.h"

#include <algorithm>
#include <memory>

#include <fmt/core.h>

#include "scene/scene.h"
#include "scene/schema.h"

namespace orrery::scene {

std::vector<NamedTexture> textures(const Scene& scene) {
  std::vector<NamedTexture> out;
  for (const Material& material : scene.materials)
    for (const TexturedKey& key : material_types()[material.model.index()].textured)
      if (const TextureSlot texture = key.get(material.model))
        out.push_back({fmt::format("material.{}.{}", material.name, key.name), key.use, texture.get()});
  return out;
}

std::vector<NamedTexture> image_textures(const Scene& scene) {
  std::vector<NamedTexture> out = textures(scene);
  std::erase_if(out, [](const NamedTexture& named) { return named.texture->type != TextureType::kImage; });
  return out;
}

void modify_textures(Scene& scene, const std::function<void(Texture& texture, TextureUse use)>& modify) {
  for (Material& material : scene.materials) {
    for (const TexturedKey& key : material_types()[material.model.index()].textured) {
      TextureSlot& slot = key.at(material.model);
      if (!slot) continue;
      const auto copy = std::make_shared<Texture>(*slot);
      modify(*copy, key.use);
      slot = copy;
    }
  }
}

}  // namespace orrery::scene
