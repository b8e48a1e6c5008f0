// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "scene/texture.h"

namespace orrery::scene {

struct Scene;

/// A texture of a scene, and the key whose value it is.
struct NamedTexture {
  std::string key;  ///< "material.earth.albedo"
  TextureUse use;
  const Texture* texture;  ///< valid until the scene's material is modified
};

/// All textures of a scene, in the order of its materials.
std::vector<NamedTexture> textures(const Scene& scene);

/// The image textures of a scene, in the same order.
std::vector<NamedTexture> image_textures(const Scene& scene);

/// Replaces every texture of a scene by a copy that `modify` has changed.
void modify_textures(Scene& scene, const std::function<void(Texture& texture, TextureUse use)>& modify);

}  // namespace orrery::scene
